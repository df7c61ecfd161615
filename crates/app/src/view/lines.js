// What is drawn as lines: the edges of surfaces where they end or bend, and the paths of balls.

const BEND = Math.cos((40 * Math.PI) / 180); // a flatter bend is no edge to the eye
const MOST_EDGES = 200_000;

// The edges of a surface as pairs of corners, six numbers each; of `all` its triangles if asked.
function edgesOf(surface, all = false) {
  const { vertices, faces } = surface;
  const corner = (i) => [vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]];
  const sides = new Map();
  if (faces.length > MOST_EDGES) return new Float32Array();
  for (let face = 0; face < faces.length; face += 3) {
    const [a, b, c] = [corner(faces[face]), corner(faces[face + 1]), corner(faces[face + 2])];
    const area = cross(subtract(b, a), subtract(c, a));
    const normal = norm(area) > 0 ? unit(area) : [0, 0, 0];
    for (let side = 0; side < 3; side++) {
      const [from, to] = [faces[face + side], faces[face + ((side + 1) % 3)]];
      const key = Math.min(from, to) * vertices.length + Math.max(from, to);
      const known = sides.get(key);
      if (known) known.normals.push(normal);
      else sides.set(key, { from, to, normals: [normal] });
    }
  }
  const lines = [];
  for (const { from, to, normals } of sides.values()) {
    const sharp = normals.length !== 2 || Math.abs(dot(normals[0], normals[1])) < BEND;
    if (all || sharp) lines.push(...corner(from), ...corner(to));
  }
  return Float32Array.from(lines);
}

// Paths as stretches of line, eight numbers each: from x, y, z, time, to x, y, z, time.
function stretches(run, balls) {
  const lines = [];
  for (const ball of balls) {
    const corners = run.trace(ball);
    for (let i = 1; i < corners.length; i++) lines.push(...corners[i - 1], ...corners[i]);
  }
  return Float32Array.from(lines);
}
