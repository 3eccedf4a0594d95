// Frames of an arm at given joint values: matrices (4, 4) column by column, as three.js has them.

/** Row-major (4, 4) numbers of the page as a column-major matrix. */
export function columnMajor(rows) {
  const m = new Float64Array(16);
  for (let i = 0; i < 4; i += 1) for (let j = 0; j < 4; j += 1) m[4 * j + i] = rows[4 * i + j];
  return m;
}

export function multiplied(a, b, out = new Float64Array(16)) {
  for (let j = 0; j < 4; j += 1) {
    for (let i = 0; i < 4; i += 1) {
      let sum = 0;
      for (let k = 0; k < 4; k += 1) sum += a[4 * k + i] * b[4 * j + k];
      out[4 * j + i] = sum;
    }
  }
  return out;
}

/** Of a rotation with a translation. */
export function inverted(m) {
  const out = new Float64Array(16);
  for (let i = 0; i < 3; i += 1) {
    for (let j = 0; j < 3; j += 1) out[4 * j + i] = m[4 * i + j];
    out[12 + i] = -(m[4 * i] * m[12] + m[4 * i + 1] * m[13] + m[4 * i + 2] * m[14]);
  }
  out[15] = 1;
  return out;
}

export const applied = (m, x, y, z) => [
  m[0] * x + m[4] * y + m[8] * z + m[12],
  m[1] * x + m[5] * y + m[9] * z + m[13],
  m[2] * x + m[6] * y + m[10] * z + m[14],
];

/** What a joint does to what it carries, at a value. */
function moved([x, y, z], slides, value) {
  const m = new Float64Array(16);
  m[15] = 1;
  if (slides) {
    m[0] = m[5] = m[10] = 1;
    m[12] = x * value;
    m[13] = y * value;
    m[14] = z * value;
    return m;
  }
  const c = Math.cos(value);
  const s = Math.sin(value);
  const v = 1 - c;
  m.set([c + x * x * v, x * y * v + z * s, x * z * v - y * s], 0);
  m.set([x * y * v - z * s, c + y * y * v, y * z * v + x * s], 4);
  m.set([x * z * v + y * s, y * z * v - x * s, c + z * z * v], 8);
  return m;
}

export class Frames {
  constructor(nodes) {
    this.nodes = nodes.map((node) => ({
      ...node,
      value: node.value ?? -1,
      axis: node.axis ?? [0, 0, 1],
      slides: node.slides ?? false,
      place: columnMajor(node.place),
    }));
  }

  /** World matrices of all nodes at joint values. */
  at(q) {
    const found = [];
    for (const node of this.nodes) {
      let m = node.parent < 0 ? node.place : multiplied(found[node.parent], node.place);
      if (node.value >= 0) m = multiplied(m, moved(node.axis, node.slides, q[node.value]));
      found.push(m);
    }
    return found;
  }
}
