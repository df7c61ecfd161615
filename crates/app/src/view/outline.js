// The picture without WebGL: edges, paths and balls on a canvas in two dimensions, nothing hidden behind anything.

class OutlinePicture {
  constructor(canvas, run) {
    this.context = canvas.getContext("2d");
    this.run = run;
    this.edges = run.surfaces.map((surface) => edgesOf(surface));
    // A mesh without a sharp edge would not be seen at all.
    this.edges = this.edges.map((edges, i) => (edges.length > 0 ? edges : edgesOf(run.surfaces[i], true)));
    this.paths = new Float32Array();
    this.marks = [];
  }

  setPaths(balls) {
    this.paths = stretches(this.run, balls);
  }

  setMarks(marks) {
    this.marks = marks;
  }

  draw(camera, now, look) {
    const { context } = this;
    const { width, height } = context.canvas;
    const { both } = camera.matrices();
    const seen = (point) => {
      const at = camera.project(both, point);
      return at && { x: at.x * width, y: at.y * height, distance: at.distance };
    };
    const line = (data, i, size) => {
      const [a, b] = [seen(data.subarray(i, i + 3)), seen(data.subarray(i + size / 2, i + size / 2 + 3))];
      if (!a || !b) return;
      context.moveTo(a.x, a.y);
      context.lineTo(b.x, b.y);
    };
    const css = (colour, alpha = 1) => `rgb(${colour.map((c) => 255 * c).join(" ")} / ${alpha})`;
    context.fillStyle = css(look.page);
    context.fillRect(0, 0, width, height);
    context.lineWidth = look.ratio;
    context.strokeStyle = css(look.edge, 0.8);
    context.beginPath();
    for (const edges of this.edges) for (let i = 0; i < edges.length; i += 6) line(edges, i, 6);
    context.stroke();
    context.lineWidth = 2 * look.ratio;
    for (const past of [false, true]) {
      context.strokeStyle = css(look.path, past ? 0.95 : 0.3);
      context.beginPath();
      for (let i = 0; i < this.paths.length; i += 8) if (this.paths[i + 7] <= now === past) line(this.paths, i, 8);
      context.stroke();
    }
    const disc = (point, radius, colour) => {
      const at = seen(point);
      if (!at) return;
      context.fillStyle = css(colour);
      context.beginPath();
      context.arc(at.x, at.y, Math.max(radius / (camera.pixel() * at.distance) * look.ratio, 3 * look.ratio), 0, 2 * Math.PI);
      context.fill();
    };
    this.marks.forEach(({ place, time }) => disc(place, 0, time <= now ? look.ink : look.faint));
    for (let ball = 0; ball < this.run.count; ball++) {
      disc(this.run.position(ball, now), this.run.radius[ball], look.tints[this.run.motionOf(ball, now)]);
    }
  }
}
