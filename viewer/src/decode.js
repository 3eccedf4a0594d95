// The page's data: JSON beside one deflated block, in which every array is whole steps of a
// fixed size, stored as differences, byte by byte.

const NOT_A_COLUMN = new Set(["at", "n", "w", "d", "s", "o", "gaps"]);

async function inflated(base64) {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k += 1) bytes[k] = binary.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function column(bytes, { at, n, w, d, s, o = 0, gaps = [] }) {
  const values = new Float64Array(n);
  for (let plane = 0; plane < w; plane += 1) {
    const scale = 256 ** plane;
    const start = at + plane * n;
    for (let k = 0; k < n; k += 1) values[k] += scale * bytes[start + k];
  }
  // The sign is in the lowest bit.
  for (let k = 0; k < n; k += 1) {
    const odd = values[k] % 2;
    values[k] = odd ? -(values[k] + 1) / 2 : values[k] / 2;
  }
  for (let order = 0; order < d; order += 1) {
    for (let k = 1; k < n; k += 1) values[k] += values[k - 1];
  }
  for (let k = 0; k < n; k += 1) values[k] = values[k] * s + o;
  for (const [first, stop] of gaps) values.fill(NaN, first, stop);
  return values;
}

const isColumn = (value) =>
  typeof value.at === "number" && Object.keys(value).every((key) => NOT_A_COLUMN.has(key));

function unpacked(value, bytes) {
  if (Array.isArray(value)) return value.map((one) => unpacked(one, bytes));
  if (value === null || typeof value !== "object") return value;
  if (isColumn(value)) return column(bytes, value);
  if (Array.isArray(value.columns) && typeof value.n === "number") {
    return value.columns.map((one) => column(bytes, one));
  }
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, unpacked(one, bytes)]));
}

/** All of the page, arrays as Float64Array; tables of arrays as a list of columns. */
export async function readPage() {
  const page = JSON.parse(document.getElementById("page").textContent);
  const bytes = await inflated(document.getElementById("arrays").textContent);
  return unpacked(page, bytes);
}
