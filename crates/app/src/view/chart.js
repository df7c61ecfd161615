// Energy over time: kinetic upon potential, of one ball or of all.

const SAMPLES = 480;

class EnergyChart {
  constructor(canvas, run, seek) {
    this.canvas = canvas;
    this.run = run;
    this.samples = [];
    this.most = 0;
    const scrub = (event) => {
      const { left, width } = canvas.getBoundingClientRect();
      seek(clamp((event.clientX - left) / width, 0, 1) * run.duration);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      scrub(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons && scrub(event));
  }

  // Takes the samples of a ball, or of all with null. At the ends of a ball's flights, just before and just after them.
  show(ball) {
    const { run } = this;
    this.ball = ball;
    this.samples = [];
    if (ball === null) {
      for (let i = 0; i <= SAMPLES; i++) {
        const time = (run.duration * i) / SAMPLES;
        this.samples.push({ time, ...run.totalEnergy(time) });
      }
    } else {
      this.sampleBall(ball);
    }
    this.most = this.samples.reduce((most, { kinetic, potential }) => Math.max(most, kinetic + potential, potential), 0);
  }

  sampleBall(ball) {
    const { run } = this;
    const [first, last] = [run.firstSegment[ball], run.firstSegment[ball + 1]];
    const step = run.duration / SAMPLES;
    for (let i = first; i < last; i++) {
      const [from, to] = [run.segmentTime[i], run.segmentEnd(ball, i)];
      const parts = clamp(Math.ceil((to - from) / step), 1, SAMPLES);
      for (let k = 0; k <= parts; k++) {
        const time = from + ((to - from) * k) / parts;
        const position = run.placeIn(i, run.fraction(ball, i, time));
        const energy = run.energyAt(ball, position, run.velocityIn(ball, i, time), run.turningIn(ball, i, time).spin);
        const mass = run.mass[ball];
        this.samples.push({ time, kinetic: mass * energy.kinetic, potential: mass * energy.potential });
      }
    }
  }

  draw(now, look) {
    const { canvas, samples, run } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0) return;
    canvas.width = width * look.ratio;
    canvas.height = height * look.ratio;
    const context = canvas.getContext("2d");
    context.scale(look.ratio, look.ratio);
    const [top, bottom] = [16, height - 16];
    const x = (time) => (time / run.duration) * width;
    const y = (energy) => bottom - (this.most > 0 ? energy / this.most : 0) * (bottom - top);
    const area = (value, colour) => {
      context.fillStyle = colour;
      context.beginPath();
      context.moveTo(x(0), bottom);
      for (const sample of samples) context.lineTo(x(sample.time), y(value(sample)));
      context.lineTo(x(samples.at(-1)?.time ?? 0), bottom);
      context.fill();
    };
    area((s) => s.kinetic + s.potential, look.css.kinetic);
    area((s) => Math.max(s.potential, 0), look.css.potential);
    context.fillStyle = look.css.line;
    context.fillRect(0, bottom, width, 1);
    context.fillStyle = look.css.ink;
    context.fillRect(x(now) - 0.75, top - 4, 1.5, bottom - top + 4);
    context.fillStyle = look.css.quiet;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "top";
    context.fillText(`${digits(this.most)} ${run.unit}`, 0, 0);
    context.fillText("0 s", 0, bottom + 3);
    context.textAlign = "right";
    context.fillText(`${digits(run.duration)} s`, width, bottom + 3);
  }

  // The values at a time, for the words beneath.
  at(now) {
    const { run, ball } = this;
    if (ball === null) return run.totalEnergy(now);
    const { kinetic, potential } = run.energy(ball, now);
    return { kinetic: run.mass[ball] * kinetic, potential: run.mass[ball] * potential };
  }
}
