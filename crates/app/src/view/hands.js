// Mouse, fingers and keys.

const fingers = new Map();
let travelled = 0;

view.addEventListener("pointerdown", (event) => {
  view.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, event);
  travelled = fingers.size > 1 ? Infinity : 0;
});

view.addEventListener("pointermove", (event) => {
  const last = fingers.get(event.pointerId);
  if (!last) return;
  const [dx, dy] = [event.clientX - last.clientX, event.clientY - last.clientY];
  travelled += Math.hypot(dx, dy);
  if (fingers.size === 2) {
    const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
    const apart = (a) => Math.hypot(a.clientX - other.clientX, a.clientY - other.clientY);
    camera.zoom(apart(last) / Math.max(apart(event), 1));
    drift(dx / 2, dy / 2);
  } else if (event.buttons & 6 || event.shiftKey) {
    drift(dx, dy);
  } else {
    camera.orbit(dx * 0.008, dy * 0.008);
  }
  fingers.set(event.pointerId, event);
  state.dirty = true;
});

function release(event) {
  if (!fingers.delete(event.pointerId)) return;
  if (event.type === "pointerup" && travelled < 6 && event.button === 0) pick(event.offsetX, event.offsetY);
}
view.addEventListener("pointerup", release);
view.addEventListener("pointercancel", release);
view.addEventListener("contextmenu", (event) => event.preventDefault());

view.addEventListener("wheel", (event) => {
  event.preventDefault();
  camera.zoom(Math.exp(clamp(event.deltaY * (event.deltaMode ? 20 : 1), -300, 300) * 0.0016));
  state.dirty = true;
}, { passive: false });

// Moving the view ends following: one cannot look elsewhere and at the ball.
function drift(dx, dy) {
  if (state.follow) follow(false);
  camera.pan(dx, dy);
  state.dirty = true;
}

// Chooses the ball or the event that is drawn nearest to a place on the picture, if it is near.
function pick(x, y) {
  const { both } = camera.matrices();
  const [width, height] = [view.clientWidth, view.clientHeight];
  let best = { off: REACH };
  const offer = (point, radius, choice) => {
    const seen = camera.project(both, point);
    if (!seen) return;
    const off = Math.hypot(seen.x * width - x, seen.y * height - y) - radius / (camera.pixel() * seen.distance);
    if (off < best.off) best = { off, ...choice };
  };
  const [first, last] = state.paths === "none" ? [0, 0] : run.eventsOf(state.ball);
  for (let i = first; i < last; i++) offer(run.event(i, state.ball).position, 0, { event: i });
  for (let ball = 0; ball < run.count; ball++) offer(run.position(ball, state.time), run.radius[ball], { ball });
  if (best.ball !== undefined) chooseBall(best.ball);
  if (best.event !== undefined) {
    play(false);
    chooseEvent(best.event);
  }
}

const KEYS = {
  " ": () => play(!state.playing),
  ",": () => stepTime(-FRAME),
  ".": () => stepTime(FRAME),
  "[": () => stepEvent(-1),
  "]": () => stepEvent(1),
  "<": () => setSpeed(-1),
  ">": () => setSpeed(1),
  n: () => chooseBall(state.ball + 1),
  p: () => chooseBall(state.ball - 1),
  f: () => follow(!state.follow),
  "+": () => camera.zoom(0.8),
  "=": () => camera.zoom(0.8),
  "-": () => camera.zoom(1.25),
  Home: () => home(),
  l: () => turnLight(),
  "?": () => element("keys").showModal(),
};
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function stepTime(seconds) {
  play(false);
  seek(state.time + seconds * Math.min(state.speed, 1));
}

function home() {
  follow(false);
  camera.home();
  state.dirty = true;
}

function turnLight() {
  redress(look.page[0] < 0.5 ? "light" : "dark");
}

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || element("keys").open) return;
  const target = event.target;
  if (target.matches("input, select") && !(target.type === "range" && event.key === " ")) return;
  if (target.matches("button") && event.key === " ") return;
  const arrow = ARROWS[event.key];
  if (arrow && event.shiftKey) drift(-30 * arrow[0], -30 * arrow[1]);
  else if (arrow) camera.orbit(-0.08 * arrow[0], -0.08 * arrow[1]);
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (!arrow && !KEYS[key]) return;
  if (!arrow) KEYS[key]();
  event.preventDefault();
  state.dirty = true;
});

const on = (id, kind, act) => element(id).addEventListener(kind, (event) => {
  act(event.target);
  state.dirty = true;
});
on("play", "click", () => play(!state.playing));
on("previous", "click", () => stepEvent(-1));
on("next", "click", () => stepEvent(1));
on("reset", "click", home);
on("zoom-in", "click", () => camera.zoom(0.8));
on("zoom-out", "click", () => camera.zoom(1.25));
on("theme", "click", turnLight);
on("help", "click", () => element("keys").showModal());
on("time", "input", (slider) => seek(Number(slider.value)));
on("ball", "change", (input) => chooseBall(Math.round(Number(input.value)) || 0));
on("follow", "change", (box) => follow(box.checked));
on("speed", "change", (list) => { state.speed = SPEEDS[Number(list.value)]; });
on("surfaces", "change", (list) => { state.surfaces = list.value; });
on("paths", "change", (list) => {
  state.paths = list.value;
  showPaths();
});
on("scope", "change", (list) => {
  state.scope = list.value;
  chart.show(state.scope === "all" ? null : state.ball);
});
dark.addEventListener("change", () => redress());
new ResizeObserver(resize).observe(view);
new ResizeObserver(() => { state.dirty = true; }).observe(element("energy"));

for (const [place, speed] of SPEEDS.entries()) element("speed").add(new Option(speedName(speed), place));
element("speed").value = String(SPEEDS.indexOf(state.speed));
element("time").max = run.duration;
element("ball").max = run.count - 1;
element("paths").value = state.paths;
resize();
camera.home();
chooseBall(0);
// What moves by itself asks first.
play(!calm.matches);

// A page can be opened at a moment and at a ball: run.html#t=1.5&ball=2&near=0.8
const wish = new URLSearchParams(location.hash.slice(1));
if (wish.has("ball")) chooseBall(Math.round(Number(wish.get("ball"))) || 0);
if (wish.has("near")) camera.zoom(Number(wish.get("near")) || 1);
if (wish.has("t")) {
  play(false);
  seek(Number(wish.get("t")) || 0);
}
// The first picture is there when the page is: a canvas that has not been drawn to is black.
frame(performance.now());

// A handle for scripts and for the console.
window.carom = { run, state, camera, seek, play, chooseBall, chooseEvent, follow, draw };
