// Vectors as arrays of three numbers, matrices as arrays of sixteen in the order of WebGL, column by column.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => times(a, 1 / norm(a));
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// A unit vector at right angles to the unit vector `n`: along the axis that n has least of.
function across(n) {
  const sizes = n.map(Math.abs);
  const axis = sizes.indexOf(Math.min(...sizes));
  const e = [0, 0, 0];
  e[axis] = 1;
  return unit(subtract(e, times(n, dot(e, n))));
}

// Quaternions, as arrays x, y, z, w: the rotation by a vector, about its direction and by its length; and two rotations, `b` and then `a`.
function rotation(turn) {
  const angle = norm(turn);
  const share = angle > 0 ? Math.sin(angle / 2) / angle : 0.5;
  return [...times(turn, share), Math.cos(angle / 2)];
}

function compose(a, b) {
  const v = add(add(times(b, a[3]), times(a, b[3])), cross(a, b));
  return [...v, a[3] * b[3] - dot(a, b)];
}

function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      product[4 * column + row] = sum;
    }
  }
  return product;
}

// The matrix that looks from `eye` along -`back`; the three axes are orthogonal units.
function lookFrom(eye, right, up, back) {
  return new Float32Array([
    right[0], up[0], back[0], 0,
    right[1], up[1], back[1], 0,
    right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ]);
}

// Perspective with `scale` = 1 / tan(half the vertical angle).
function perspective(scale, aspect, near, far) {
  const depth = 1 / (near - far);
  return new Float32Array([scale / aspect, 0, 0, 0, 0, scale, 0, 0, 0, 0, (near + far) * depth, -1, 0, 0, 2 * near * far * depth, 0]);
}

// A number that somebody wrote, as it was before it became one of single precision.
const plain = (x) => String(Number(x.toPrecision(7))).replaceAll("-", "−");

// Four digits that count, and no more noughts than needed.
function digits(x, count = 4) {
  if (!Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) return x.toExponential(count - 1).replace("e+", "e").replaceAll("-", "−");
  const decimals = clamp(count - 1 - Math.floor(Math.log10(size)), 0, 8);
  return x.toFixed(decimals).replace("-", "−");
}
