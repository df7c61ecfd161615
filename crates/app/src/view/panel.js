// What stands beside the picture: the ball, its energy and its events in words and numbers.

const MOST_ROWS = 300;

const element = (id) => document.getElementById(id);

// Terms with their values, as the children of a <dl>.
function describe(list, entries) {
  const parts = entries.flatMap(([term, value]) => {
    const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
    dt.textContent = term;
    dd.textContent = value;
    return [dt, dd];
  });
  list.replaceChildren(...parts);
}

// What single precision leaves of a coordinate that is none, in a run of that size, is none.
const coordinates = (place, size) => triple(place.map((x) => (Math.abs(x) < size * 2 ** -22 ? 0 : x)));

const triple = (v, count = 4) => v.map((x) => digits(x, count)).join(", ");

class Panel {
  constructor(run, choose) {
    this.run = run;
    this.choose = choose;
    element("title").textContent = run.title;
    element("summary").textContent = run.summary.join("\n");
    document.title = `${run.title} – Carom`;
    element("events").addEventListener("click", (click) => {
      const row = click.target.closest("button");
      if (row) choose(Number(row.dataset.event));
    });
  }

  // The balls by what they do, or the one that is chosen by what it is.
  legend(now, counts) {
    const items = Object.entries(counts).filter(([, n]) => n > 0).map(([name, n]) => {
      const item = document.createElement("span");
      const dot = document.createElement("span");
      dot.className = "dot";
      dot.style.background = `var(--${name === "ended" ? "quiet" : name})`;
      item.append(dot, `${n} ${name}`);
      return item;
    });
    element("legend").replaceChildren(...items);
  }

  readout(ball, now) {
    const { run } = this;
    const velocity = run.velocity(ball, now);
    const place = add(run.position(ball, now), run.origin);
    const { spin } = run.turning(ball, now);
    const turns = norm(spin) / (2 * Math.PI);
    describe(element("readout"), [
      ["state", run.motionOf(ball, now)],
      ["position", `${coordinates(place, run.size)} m`],
      ["velocity", `${triple(velocity)} m/s`],
      ["speed", `${digits(norm(velocity))} m/s`],
      ...(run.turns ? [["spin", `${triple(spin)} rad/s`], ["turns", `${digits(turns)} a second`]] : []),
      ["radius", run.radius[ball] > 0 ? `${plain(run.radius[ball])} m` : "a point"],
    ]);
  }

  energy(values) {
    const entries = [["kinetic", values.kinetic], ["potential", values.potential]];
    const parts = entries.map(([name, value]) => {
      const dot = document.createElement("span");
      dot.className = "dot square";
      dot.style.background = `var(--${name})`;
      const item = document.createElement("span");
      item.append(dot, `${name} ${digits(value)} ${this.run.unit}`);
      return item;
    });
    element("energy-legend").replaceChildren(parts[0], "  ", parts[1]);
  }

  // The rows of a ball's events; around `current` where there are too many.
  events(ball, current) {
    const { run } = this;
    const [first, last] = run.eventsOf(ball);
    const count = last - first;
    const from = count > MOST_ROWS ? clamp(current - MOST_ROWS / 2, first, last - MOST_ROWS) : first;
    const to = Math.min(last, from + MOST_ROWS);
    const shown = to - from < count ? ` (${to - from} shown)` : "";
    element("event-count").textContent = count === 0 ? "none" : `${count}${shown}`;
    if (this.rows?.ball !== ball || this.rows.from !== from) {
      this.rows = { ball, from, to };
      const rows = [];
      for (let i = from; i < to; i++) {
        const { time, kind, surface } = run.event(i, ball);
        const row = document.createElement("button");
        row.type = "button";
        row.dataset.event = i;
        row.setAttribute("role", "listitem");
        const [when, what] = [document.createElement("span"), document.createElement("span")];
        when.textContent = `${digits(time, 5)} s`;
        what.textContent = `${kind}, ${surface}`;
        row.append(when, what);
        rows.push(row);
      }
      element("events").replaceChildren(...rows);
    }
    for (const row of element("events").children) {
      const isCurrent = Number(row.dataset.event) === current;
      row.setAttribute("aria-current", String(isCurrent));
      if (isCurrent) keepInSight(row);
    }
  }

  // The data of one event, or nothing.
  event(index, ball) {
    if (index === null) {
      element("event").replaceChildren();
      return;
    }
    const { run } = this;
    const event = run.event(index, ball);
    // What single precision leaves of no speed at all is none.
    const along = (v) => (Math.abs(dot(v, event.normal)) > 1e-6 * norm(v) ? dot(v, event.normal) : 0);
    const closing = 0 - along(event.velocityIn);
    const leaving = along(event.velocityOut);
    const before = run.energyAt(ball, event.position, event.velocityIn, event.spinIn).kinetic;
    const after = run.energyAt(ball, event.position, event.velocityOut, event.spinOut).kinetic;
    describe(element("event"), [
      ["event", `${event.kind} at ${digits(event.time, 7)} s`],
      ["surface", event.face >= 0 ? `${event.surface}, face ${event.face}` : event.surface],
      ["position", `${coordinates(add(event.position, run.origin), run.size)} m`],
      ["normal", triple(event.normal)],
      ["v before", `${triple(event.velocityIn)} m/s`],
      ["v after", `${triple(event.velocityOut)} m/s`],
      ...(run.turns ? [["spin before", `${triple(event.spinIn)} rad/s`], ["spin after", `${triple(event.spinOut)} rad/s`]] : []),
      ["closing, leaving", `${digits(closing)}, ${digits(leaving)} m/s`],
      ["energy lost", before > 0 ? `${digits((100 * (before - after)) / before)} % of the kinetic` : "none"],
    ]);
  }
}

// Scrolls the list, and not the page, so that a row is in it.
function keepInSight(row) {
  const list = row.parentElement;
  const top = row.offsetTop - list.offsetTop;
  if (top < list.scrollTop) list.scrollTop = top;
  else if (top + row.offsetHeight > list.scrollTop + list.clientHeight) {
    list.scrollTop = top + row.offsetHeight - list.clientHeight;
  }
}
