// Colours that colour-blind readers tell apart: Okabe and Ito's for names, viridis for amounts.

export const NAMED = [
  "#0072b2",
  "#d55e00",
  "#009e73",
  "#cc79a7",
  "#e69f00",
  "#56b4e9",
  "#8c6d1f",
  "#7f7f7f",
  "#5b4fc7",
];

const VIRIDIS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
// Of deviations: blue, straw, orange; the middle one stands out from light and dark ground.
const DIVERGING = [
  [5, 113, 176],
  [122, 178, 196],
  [216, 205, 128],
  [243, 160, 80],
  [200, 80, 8],
];

function along(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  return [0, 1, 2].map((i) => (stops[k][i] + (at - k) * (stops[k + 1][i] - stops[k][i])) / 255);
}

/** The darkest is left out on dark ground, the brightest on bright. */
export const viridis = (share, theme = "light") =>
  along(VIRIDIS, theme === "dark" ? 0.16 + 0.84 * Math.min(Math.max(share, 0), 1) : 0.92 * Math.min(Math.max(share, 0), 1));
export const diverging = (share) => along(DIVERGING, share);
export const css = ([r, g, b]) => `rgb(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)})`;
export const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);

/** What kinds of limits there are, in the order in which a legend has them. */
export const KINDS = [
  { key: "asked", name: "programmed acceleration", colour: "#8a63c9", test: /^programmed.*acceleration/ },
  { key: "programmed", name: "programmed speed", colour: "#0072b2", test: /^programmed/ },
  { key: "torque", name: "torque", colour: "#e69f00", test: /torque$/ },
  { key: "centripetal", name: "centripetal", colour: "#009e73", test: /^centripetal/ },
  { key: "acceleration", name: "acceleration", colour: "#d55e00", test: /acceleration$/ },
  { key: "velocity", name: "joint speed", colour: "#56b4e9", test: /velocity$|speed$/ },
  { key: "corner", name: "zone", colour: "#cc79a7", test: /^corner/ },
  { key: "stop", name: "stop", colour: "#7f7f7f", test: /./ },
];
export const REST = { key: "rest", name: "standing still", colour: "#c9c9c9" };

export const kindOf = (name) => (name === undefined ? REST : KINDS.find((kind) => kind.test.test(name)));
