// The player: time goes on, and the user has it in hand.

const SPEEDS = [1 / 64, 1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8, 16, 32, 64];
const FRAME = 1 / 60;
const PATHS_OF_ALL = 12; // with more balls, paths of all of them are a tangle
const REACH = 22; // how far from a ball, in pixels, a finger may miss it

const run = new Run(JSON.parse(element("run").textContent));
const canvas = element("view");
const camera = new Camera(run);
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

const state = {
  time: 0,
  playing: false,
  // A long run is over in a minute, a short one takes its time.
  speed: SPEEDS.find((speed) => speed >= 1 && run.duration / speed <= 60) ?? SPEEDS.at(-1),
  ball: 0,
  mark: null,
  follow: false,
  surfaces: "auto",
  paths: run.count <= PATHS_OF_ALL ? "all" : "ball",
  scope: "ball",
  dirty: true,
};

function makePicture() {
  try {
    return new WebGLPicture(canvas, run);
  } catch (error) {
    // A canvas that has been asked for WebGL gives nothing else any more.
    const fresh = canvas.cloneNode();
    canvas.replaceWith(fresh);
    notify(`This browser shows no WebGL 2 (${error.message}): the run is drawn in outline.`);
    return new OutlinePicture(fresh, run);
  }
}

function notify(text) {
  element("notice").textContent = text;
  element("notice").hidden = false;
}

const picture = makePicture();
const view = element("view");
const panel = new Panel(run, chooseEvent);
const chart = new EnergyChart(element("energy"), run, seek);

// The colours of the page, as CSS and in thirds for WebGL; read anew when light and dark change.
function readLook() {
  const style = getComputedStyle(document.documentElement);
  const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const part = document.createElement("i");
  document.body.append(part);
  const colour = (name) => {
    part.style.color = `var(--${name})`;
    probe.fillStyle = getComputedStyle(part).color;
    probe.fillRect(0, 0, 1, 1);
    return Array.from(probe.getImageData(0, 0, 1, 1).data.subarray(0, 3), (c) => c / 255);
  };
  const css = (name) => `rgb(${colour(name).map((c) => 255 * c).join(" ")})`;
  const page = colour("page");
  const isDark = page[0] < 0.5;
  const light = [[0.79, 0.82, 0.86], [0.86, 0.81, 0.73], [0.76, 0.84, 0.78], [0.84, 0.78, 0.83], [0.77, 0.81, 0.89], [0.86, 0.85, 0.74]];
  const night = [[0.3, 0.35, 0.42], [0.38, 0.34, 0.27], [0.27, 0.37, 0.32], [0.37, 0.31, 0.36], [0.29, 0.33, 0.43], [0.36, 0.36, 0.25]];
  const look = {
    page,
    ink: colour("ink"),
    faint: colour("quiet"),
    edge: colour("quiet"),
    path: colour("accent"),
    later: colour("later"),
    tints: { flying: colour("flying"), sliding: colour("sliding"), rolling: colour("rolling"), resting: colour("resting"), ended: colour("quiet") },
    palette: isDark ? night : light,
    contrast: isDark ? 0.62 : 0.5,
    spacing: 10 ** Math.round(Math.log10(run.size / 12)),
    css: { kinetic: css("kinetic"), potential: css("potential"), line: css("line"), ink: css("ink"), quiet: css("quiet") },
  };
  part.remove();
  return look;
}

let look = readLook();

function seek(time) {
  state.time = clamp(time, 0, run.duration);
  state.dirty = true;
}

function play(on) {
  if (on && state.time >= run.duration) seek(0);
  state.playing = on;
  state.dirty = true;
  element("play").setAttribute("aria-label", on ? "Pause" : "Play");
  element("play").title = on ? "Pause (Space)" : "Play (Space)";
  element("play-shape").setAttribute("d", on ? "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z" : "M4 2.5v11l9-5.5z");
}

function say(text) {
  element("live").textContent = text;
}

function chooseBall(ball) {
  state.ball = ((ball % run.count) + run.count) % run.count;
  state.mark = null;
  element("ball").value = state.ball;
  showPaths();
  if (state.scope === "ball") chart.show(state.ball);
  if (state.follow) approach();
  say(`Ball ${state.ball}, ${run.motionOf(state.ball, state.time)}`);
  state.dirty = true;
}

function showPaths() {
  const all = Array.from({ length: run.count }, (_, i) => i);
  picture.setPaths({ ball: [state.ball], all, none: [] }[state.paths]);
  const [first, last] = run.eventsOf(state.ball);
  const events = Array.from({ length: last - first }, (_, i) => run.event(first + i, state.ball));
  picture.setMarks(state.paths === "none" ? [] : events.map(({ time, position }) => ({ time, place: position })));
  state.dirty = true;
}

// The last event of the ball at the time or before; -1 for none.
function eventBefore(time) {
  const [first, last] = run.eventsOf(state.ball);
  let found = -1;
  for (let i = first; i < last && run.eventTime[i] <= time; i++) found = i;
  return found;
}

function chooseEvent(index) {
  state.mark = index;
  seek(run.eventTime[index]);
  const { kind, surface, time } = run.event(index, state.ball);
  say(`${kind} on ${surface} at ${digits(time, 5)} seconds`);
}

function stepEvent(way) {
  const [first, last] = run.eventsOf(state.ball);
  if (first === last) return;
  play(false);
  // From an event that is chosen to the next one, even at the same time.
  const from = state.mark ?? eventBefore(state.time) + (way > 0 ? 0 : 1);
  chooseEvent(clamp(from < first ? first : from + way, first, last - 1));
}

function follow(on) {
  state.follow = on;
  element("follow").checked = on;
  if (on) approach();
  say(on ? `Following ball ${state.ball}` : "Not following");
  state.dirty = true;
}

// Near enough to see the ball that is followed.
function approach() {
  const near = Math.max(30 * run.radius[state.ball], run.size / 12);
  camera.zoom(Math.min(1, near / camera.distance));
}

function setSpeed(way) {
  const place = clamp(SPEEDS.indexOf(state.speed) + way, 0, SPEEDS.length - 1);
  state.speed = SPEEDS[place];
  element("speed").value = String(place);
  say(`Speed ${speedName(state.speed)}`);
}

const speedName = (speed) => (speed < 1 ? `1/${1 / speed} ×` : `${speed} ×`);

function resize() {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const [width, height] = [Math.max(view.clientWidth, 1), Math.max(view.clientHeight, 1)];
  view.width = width * ratio;
  view.height = height * ratio;
  camera.resize(width, height);
  look.ratio = ratio;
  state.dirty = true;
}

function redress(theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  look = { ...readLook(), ratio: look.ratio };
  state.dirty = true;
}

function draw() {
  const { time, ball } = state;
  if (state.follow) camera.target = run.position(ball, time);
  const [first] = run.eventsOf(ball);
  if (state.mark !== null && run.eventTime[state.mark] !== time) state.mark = null;
  const chosen = state.mark === null ? null : state.mark - first;
  picture.draw(camera, time, { ...look, ball, mark: chosen, surfaces: state.surfaces });
  const counts = { flying: 0, sliding: 0, rolling: 0, resting: 0, ended: 0 };
  for (let i = 0; i < run.count; i++) counts[run.motionOf(i, time)] += 1;
  panel.legend(time, counts);
  panel.readout(ball, time);
  const current = state.mark ?? eventBefore(time);
  panel.events(ball, current);
  panel.event(current < first ? null : current, ball);
  chart.draw(time, look);
  panel.energy(chart.at(time));
  element("time").value = time;
  const shown = time.toFixed(run.duration < 30 ? 3 : 2);
  element("clock").textContent = `${shown} / ${digits(run.duration)} s`;
  element("time").setAttribute("aria-valuetext", `${shown} seconds`);
}

let before = performance.now();

function frame(now) {
  const passed = Math.min((now - before) / 1000, 0.1);
  before = now;
  if (state.playing) {
    seek(state.time + passed * state.speed);
    if (state.time >= run.duration) play(false);
  }
  if (state.dirty) {
    state.dirty = false;
    draw();
  }
  requestAnimationFrame(frame);
}
