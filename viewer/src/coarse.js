// Meshes of fewer triangles, for browsers that draw without a graphics card: points near to each
// other become one.

const FINEST = 128; // cells along the longest side to begin with
const COARSER = 1.4;
const FACING = 0.5; // of a normal, along an axis

/** A mesh of at most so many triangles, on as fine a grid as that allows. */
export function coarse({ vertices, faces }, most) {
  let made = { vertices, faces };
  for (let cells = FINEST; made.faces[0].length > most && cells >= 8; cells /= COARSER) {
    made = clustered({ vertices, faces }, cells);
  }
  return made;
}

/** Vertices of one cell of a grid drawn as one, in their middle; faces that keep three. Those that
 * face to opposite sides stay two, so that thin walls stay walls. */
function clustered({ vertices, faces }, cells) {
  const count = vertices[0].length;
  const low = vertices.map((column) => column.reduce((least, v) => Math.min(least, v), Infinity));
  const high = vertices.map((column) => column.reduce((most, v) => Math.max(most, v), -Infinity));
  const size = Math.max(...high.map((v, i) => v - low[i]), 1e-9) / cells;
  const facing = normals(vertices, faces);
  const named = new Map();
  const of = new Int32Array(count);
  const sums = [[], [], [], []];
  for (let k = 0; k < count; k += 1) {
    const key = vertices.map((column, i) => `${Math.floor((column[k] - low[i]) / size)}${side(facing, k, i)}`).join("");
    if (!named.has(key)) {
      named.set(key, named.size);
      for (const column of sums) column.push(0);
    }
    of[k] = named.get(key);
    for (let i = 0; i < 3; i += 1) sums[i][of[k]] += vertices[i][k];
    sums[3][of[k]] += 1;
  }
  const kept = [[], [], []];
  for (let k = 0; k < faces[0].length; k += 1) {
    const [a, b, c] = faces.map((column) => of[column[k]]);
    if (a === b || b === c || c === a) continue;
    [a, b, c].forEach((corner, i) => kept[i].push(corner));
  }
  return { vertices: sums.slice(0, 3).map((column) => column.map((v, k) => v / sums[3][k])), faces: kept };
}

/** To which side of an axis the surface faces at a point, where it clearly does. */
function side(facing, k, i) {
  const share = facing[3 * k + i] / (Math.hypot(facing[3 * k], facing[3 * k + 1], facing[3 * k + 2]) || 1);
  return share > FACING ? "+" : share < -FACING ? "-" : " ";
}

/** Where the surface faces at each point: the sum of its triangles' normals, flat. */
function normals(vertices, faces) {
  const found = new Float64Array(3 * vertices[0].length);
  for (let k = 0; k < faces[0].length; k += 1) {
    const corners = faces.map((column) => column[k]);
    const [a, b, c] = corners.map((corner) => vertices.map((column) => column[corner]));
    const [u, v] = [b, c].map((point) => point.map((value, i) => value - a[i]));
    for (const corner of corners) {
      for (let i = 0; i < 3; i += 1) found[3 * corner + i] += u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    }
  }
  return found;
}
