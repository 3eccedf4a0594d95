// Lines of fewer points that look the same: Douglas and Peucker's, in place and colour at once.

const OFF = 3e-4; // m
const SHADE = 0.03; // of a colour's part, 0 to 1

/** Indices from..to−1 of points that are kept; xyz is flat, shades a colour for each point; rough:
 * how many times as far as usual lines may be off. */
export function fewer(xyz, shades, from, to, rough = 1) {
  const keep = new Uint8Array(to - from);
  keep[0] = keep[to - from - 1] = 1;
  const stack = [[from, to - 1]];
  while (stack.length) {
    const [a, b] = stack.pop();
    let worst = rough;
    let at = -1;
    for (let k = a + 1; k < b; k += 1) {
      const off = missed(xyz, shades, a, b, k);
      if (off > worst) [worst, at] = [off, k];
    }
    if (at < 0) continue;
    keep[at - from] = 1;
    stack.push([a, at], [at, b]);
  }
  const kept = [];
  for (let k = from; k < to; k += 1) if (keep[k - from]) kept.push(k);
  return kept;
}

/** How far a point is off the line between two others, in what may be off. */
function missed(xyz, shades, a, b, k) {
  let along = 0;
  let length = 0;
  for (let i = 0; i < 3; i += 1) {
    const d = xyz[3 * b + i] - xyz[3 * a + i];
    along += d * (xyz[3 * k + i] - xyz[3 * a + i]);
    length += d * d;
  }
  const share = length > 0 ? Math.min(Math.max(along / length, 0), 1) : 0;
  let off = 0;
  let shade = 0;
  for (let i = 0; i < 3; i += 1) {
    const at = xyz[3 * a + i] + share * (xyz[3 * b + i] - xyz[3 * a + i]);
    off += (xyz[3 * k + i] - at) ** 2;
    const meant = shades[a][i] + share * (shades[b][i] - shades[a][i]);
    shade = Math.max(shade, Math.abs(shades[k][i] - meant));
  }
  return Math.max(Math.sqrt(off) / OFF, shade / SHADE);
}
