// The camera: it looks at a point from some way off, turned about the vertical and tilted.

const LENS = 2.2; // 1 / tan(half the vertical angle): about 49 degrees from top to bottom

class Camera {
  constructor(run) {
    this.landmarks = run.landmarks();
    this.radius = norm(run.half);
    this.up = run.up;
    this.east = across(run.up);
    this.north = cross(this.up, this.east);
    this.aspect = 1;
    this.height = 1;
    this.home();
  }

  home() {
    this.turn = -0.9;
    this.tilt = 0.42;
    this.target = [0, 0, 0];
    this.distance = this.whole();
    this.isHome = true;
  }

  // The distance from which all there is to see is just in the picture, with a margin.
  whole() {
    const { right, above, back } = this.axes();
    const room = 0.84;
    let distance = this.radius / 10;
    for (const point of this.landmarks) {
      const reach = Math.max(Math.abs(dot(point, right)) / this.aspect, Math.abs(dot(point, above)));
      distance = Math.max(distance, dot(point, back) + (reach * LENS) / room);
    }
    return distance;
  }

  resize(width, height) {
    this.aspect = width / height;
    this.height = height;
    // What was seen whole stays so.
    if (this.isHome) this.distance = this.whole();
  }

  orbit(dx, dy) {
    this.isHome = false;
    this.turn -= dx;
    this.tilt = clamp(this.tilt + dy, -1.5, 1.5);
  }

  zoom(factor) {
    this.isHome = false;
    this.distance = clamp(this.distance * factor, this.radius * 1e-5, this.radius * 40);
  }

  // Moves by pixels of the screen.
  pan(dx, dy) {
    this.isHome = false;
    const { right, above } = this.axes();
    const metres = (2 * this.distance) / (LENS * this.height);
    this.target = add(this.target, add(times(right, -dx * metres), times(above, dy * metres)));
  }

  axes() {
    const level = add(times(this.east, Math.cos(this.turn)), times(this.north, Math.sin(this.turn)));
    const back = add(times(level, Math.cos(this.tilt)), times(this.up, Math.sin(this.tilt)));
    const right = unit(cross(this.up, level));
    return { right, above: cross(back, right), back };
  }

  eye() {
    return add(this.target, times(this.axes().back, this.distance));
  }

  // The matrices of a picture. The nearest thing drawn is a fiftieth of the way to the target, the farthest behind everything.
  matrices() {
    const { right, above, back } = this.axes();
    const view = lookFrom(this.eye(), right, above, back);
    const far = this.distance + norm(this.target) + 4 * this.radius;
    const projection = perspective(LENS, this.aspect, this.distance / 50, far);
    return { view, projection, both: multiply(projection, view) };
  }

  // Metres for a pixel at the distance 1.
  pixel() {
    return 2 / (LENS * this.height);
  }

  // Where a point is on the screen, in [0, 1] from the upper left, and how far away; null behind the eye.
  project(matrix, point) {
    const w = matrix[3] * point[0] + matrix[7] * point[1] + matrix[11] * point[2] + matrix[15];
    if (w <= 0) return null;
    const row = (k) => matrix[k] * point[0] + matrix[4 + k] * point[1] + matrix[8 + k] * point[2] + matrix[12 + k];
    return { x: (row(0) / w + 1) / 2, y: (1 - row(1) / w) / 2, distance: w };
  }
}
