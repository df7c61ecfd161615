// The run: what the program wrote into this page, and where every ball is at any time of it.

const MOTIONS = ["flying", "sliding", "rolling", "resting"];
const OWN_VELOCITY = 16; // what a degree has more when the velocity has terms of its own

function unpack(text, Type) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  return new Type(bytes.buffer);
}

class Run {
  constructor(data) {
    this.title = data.title;
    this.summary = data.summary;
    this.duration = data.duration;
    this.gravity = data.gravity ?? [0, 0, 0];
    this.up = data.up;
    this.unit = data.energy_unit;
    this.origin = data.origin;
    this.half = data.half;
    this.size = 2 * Math.max(...data.half);
    this.surfaces = data.surfaces.map((surface) => ({
      ...surface,
      vertices: unpack(surface.vertices, Float32Array),
      faces: unpack(surface.faces, Uint32Array),
    }));
    const { balls, segments, turning, events } = data;
    this.radius = unpack(balls.radius, Float32Array);
    this.mass = unpack(balls.mass, Float32Array);
    this.inertia = unpack(balls.inertia, Float32Array);
    this.end = unpack(balls.end, Float64Array);
    this.count = this.radius.length;
    this.firstSegment = unpack(balls.segments, Uint32Array);
    this.firstEvent = unpack(balls.events, Uint32Array);
    this.segmentTime = unpack(segments.time, Float64Array);
    this.segmentSeconds = unpack(segments.seconds, Float64Array);
    this.degree = unpack(segments.degree, Uint8Array);
    this.terms = unpack(segments.terms, Float32Array);
    this.placeTerms();
    this.motion = unpack(segments.motion, Uint8Array);
    this.turns = turning !== null;
    this.orientations = this.turns && unpack(turning.orientation, Float32Array);
    this.spins = this.turns && unpack(turning.spin, Float32Array);
    this.decays = this.turns && unpack(turning.decay, Float32Array);
    this.kinds = events.kinds;
    this.eventTime = unpack(events.time, Float64Array);
    this.eventKind = unpack(events.kind, Uint8Array);
    this.eventSurface = unpack(events.surface, Uint32Array);
    this.eventFace = unpack(events.face, Int32Array);
    this.eventNormal = unpack(events.normal, Float32Array);
    this.eventIn = unpack(events.velocity_in, Float32Array);
    this.eventOut = unpack(events.velocity, Float32Array);
    // Where each ball was looked for last: the next time it is mostly there, or one further.
    this.cursor = Int32Array.from(this.firstSegment.subarray(0, this.count));
    this.floor = this.lowestPotential();
  }

  // Where the terms of each segment begin, and where those of its velocity do if they are its own, else 0.
  placeTerms() {
    this.pathAt = new Uint32Array(this.degree.length);
    this.velocityAt = new Uint32Array(this.degree.length);
    let place = 0;
    for (let i = 0; i < this.degree.length; i++) {
      const own = this.degree[i] >= OWN_VELOCITY;
      this.degree[i] %= OWN_VELOCITY;
      const width = 3 * (this.degree[i] + 1);
      this.pathAt[i] = place;
      place += width;
      if (own) {
        this.velocityAt[i] = place;
        place += width;
      }
    }
  }

  // The segment of `ball` at `time`: the last that begins then or before.
  segment(ball, time) {
    const first = this.firstSegment[ball];
    const last = this.firstSegment[ball + 1] - 1;
    let low = clamp(this.cursor[ball], first, Math.max(first, last));
    const begins = this.segmentTime;
    const here = (i) => begins[i] <= time && (i >= last || begins[i + 1] > time);
    if (!here(low)) {
      if (low < last && here(low + 1)) {
        low += 1;
      } else {
        let high = last;
        low = first;
        while (low < high) {
          const middle = (low + high + 1) >> 1;
          if (begins[middle] <= time) low = middle;
          else high = middle - 1;
        }
      }
    }
    this.cursor[ball] = low;
    return low;
  }

  segmentEnd(ball, segment) {
    return segment + 1 < this.firstSegment[ball + 1] ? this.segmentTime[segment + 1] : this.end[ball];
  }

  // Whether there is nothing of the ball but its start: the simulation ended before it moved.
  isStill(ball) {
    return this.firstSegment[ball] === this.firstSegment[ball + 1];
  }

  // f of `time` in a segment of `ball`.
  fraction(ball, segment, time) {
    const at = clamp(time, this.segmentTime[segment], this.segmentEnd(ball, segment));
    return (at - this.segmentTime[segment]) / this.segmentSeconds[segment];
  }

  // The sum of the terms f^k of a segment, of its path or its velocity, that begin at `base`.
  polynomial(base, segment, f) {
    const sum = [0, 0, 0];
    for (let k = 3 * this.degree[segment]; k >= 0; k -= 3) {
      for (let axis = 0; axis < 3; axis++) sum[axis] = sum[axis] * f + this.terms[base + k + axis];
    }
    return sum;
  }

  // The place at `f` of a segment.
  placeIn(segment, f) {
    return this.polynomial(this.pathAt[segment], segment, f);
  }

  // Relative to the origin of the run.
  position(ball, time) {
    if (this.isStill(ball)) return [0, 0, 0];
    const segment = this.segment(ball, time);
    return this.placeIn(segment, this.fraction(ball, segment, time));
  }

  velocity(ball, time) {
    if (this.isStill(ball)) return [0, 0, 0];
    const segment = this.segment(ball, time);
    return this.velocityIn(ball, segment, time);
  }

  // The velocity at `time` within a segment, whichever comes after it.
  velocityIn(ball, segment, time) {
    const f = this.fraction(ball, segment, time);
    if (this.velocityAt[segment] > 0) return this.polynomial(this.velocityAt[segment], segment, f);
    const base = this.pathAt[segment];
    const sum = [0, 0, 0];
    for (let k = this.degree[segment]; k >= 1; k--) {
      for (let axis = 0; axis < 3; axis++) sum[axis] = sum[axis] * f + k * this.terms[base + 3 * k + axis];
    }
    return times(sum, 1 / this.segmentSeconds[segment]);
  }

  // The angular velocity at `time` within a segment, and how the ball has turned by then: as the program's `Turning` has it.
  turningIn(ball, segment, time) {
    if (!this.turns) return { spin: [0, 0, 0], orientation: [0, 0, 0, 1] };
    const [begin, end] = [this.segmentTime[segment], this.segmentEnd(ball, segment)];
    const seconds = clamp(time, begin, end) - begin;
    const from = Array.from(this.spins.subarray(6 * segment, 6 * segment + 3));
    const to = Array.from(this.spins.subarray(6 * segment + 3, 6 * segment + 6));
    const before = Array.from(this.orientations.subarray(4 * segment, 4 * segment + 4));
    const tau = this.decays[segment];
    if (tau > 0) {
      const left = Math.exp(-seconds / tau);
      return { spin: times(from, left), orientation: compose(rotation(times(from, tau * (1 - left))), before) };
    }
    const spin = end > begin ? add(from, times(subtract(to, from), seconds / (end - begin))) : to;
    const twist = norm(cross(from, spin)) * seconds ** 2;
    const turn = Math.max(norm(from), norm(spin)) * seconds;
    const steps = clamp(Math.ceil(Math.min(8 * Math.sqrt(twist), 2 * turn)), 1, 256);
    const step = seconds / steps;
    let orientation = before;
    for (let k = 0; k < steps; k++) {
      const [a, b] = [k, k + 1].map((k) => add(from, times(subtract(spin, from), k / steps)));
      const turned = add(times(add(a, b), step / 2), times(cross(b, a), step ** 2 / 12));
      orientation = compose(rotation(turned), orientation);
    }
    return { spin, orientation };
  }

  turning(ball, time) {
    if (this.isStill(ball)) return { spin: [0, 0, 0], orientation: [0, 0, 0, 1] };
    return this.turningIn(ball, this.segment(ball, time), time);
  }

  motionOf(ball, time) {
    if (this.isStill(ball) || (time > this.end[ball] && this.end[ball] < this.duration)) return "ended";
    return MOTIONS[this.motion[this.segment(ball, time)]];
  }

  // v^2 / 2, of turning too, and -g . x per kg, the potential from the lowest ball, as the program's own balance has it.
  energyAt(ball, position, velocity, spin) {
    const surface = times(spin, this.radius[ball]);
    const kinetic = (dot(velocity, velocity) + this.inertia[ball] * dot(surface, surface)) / 2;
    return { kinetic, potential: -dot(this.gravity, position) - this.floor };
  }

  energy(ball, time) {
    return this.energyAt(ball, this.position(ball, time), this.velocity(ball, time), this.turning(ball, time).spin);
  }

  totalEnergy(time) {
    let [kinetic, potential] = [0, 0];
    for (let ball = 0; ball < this.count; ball++) {
      const energy = this.energy(ball, time);
      kinetic += this.mass[ball] * energy.kinetic;
      potential += this.mass[ball] * energy.potential;
    }
    return { kinetic, potential };
  }

  lowestPotential() {
    let lowest = Infinity;
    for (let ball = 0; ball < this.count; ball++) {
      for (const time of [0, this.duration]) lowest = Math.min(lowest, -dot(this.gravity, this.position(ball, time)));
    }
    return lowest;
  }

  // The events of a ball, by their numbers in the lists.
  eventsOf(ball) {
    return [this.firstEvent[ball], this.firstEvent[ball + 1]];
  }

  event(index, ball) {
    const vector = (list) => Array.from(list.subarray(3 * index, 3 * index + 3));
    const time = this.eventTime[index];
    return {
      time,
      kind: this.kinds[this.eventKind[index]],
      surface: this.surfaces[this.eventSurface[index]]?.name ?? "",
      face: this.eventFace[index],
      position: this.position(ball, time),
      normal: vector(this.eventNormal),
      velocityIn: vector(this.eventIn),
      velocityOut: vector(this.eventOut),
      ...this.spinsAt(ball, time),
    };
  }

  // The angular velocities just before and just after a moment.
  spinsAt(ball, time) {
    if (!this.turns || this.isStill(ball)) return { spinIn: [0, 0, 0], spinOut: [0, 0, 0] };
    const after = this.segment(ball, time);
    let before = after;
    while (before > this.firstSegment[ball] && this.segmentTime[before] >= time) before -= 1;
    const spin = (segment) => this.turningIn(ball, segment, time).spin;
    return { spinIn: spin(before), spinOut: spin(after) };
  }

  // Some hundred points of what there is to see, spread over all of it.
  landmarks() {
    const points = [];
    const take = (count, point) => {
      const stride = Math.max(1, Math.ceil(count / 400));
      for (let i = 0; i < count; i += stride) points.push(point(i));
    };
    for (const { vertices } of this.surfaces) {
      take(vertices.length / 3, (i) => Array.from(vertices.subarray(3 * i, 3 * i + 3)));
    }
    // Where stretches of motion begin, but for those of balls that have left.
    take(this.degree.length, (i) => this.placeIn(i, 0));
    const within = (point) => point.every((x, axis) => Math.abs(x) <= this.half[axis] * (1 + 1e-5));
    return points.filter(within);
  }

  // The path of a ball as corners of a polyline: [x, y, z, time] each, close enough together that its bends look round.
  trace(ball) {
    const corners = [];
    for (let i = this.firstSegment[ball]; i < this.firstSegment[ball + 1]; i++) {
      const from = this.segmentTime[i];
      const to = this.segmentEnd(ball, i);
      const f = (to - from) / this.segmentSeconds[i];
      let bend = 0;
      for (let k = 2; k <= this.degree[i]; k++) {
        const at = this.pathAt[i] + 3 * k;
        bend += norm(this.terms.subarray(at, at + 3)) * f ** k;
      }
      const parts = clamp(Math.ceil(Math.sqrt((400 * bend) / this.size)), 1, 48);
      for (let k = 0; k < parts; k++) {
        corners.push([...this.placeIn(i, (f * k) / parts), from + ((to - from) * k) / parts]);
      }
      if (i + 1 === this.firstSegment[ball + 1]) corners.push([...this.placeIn(i, f), to]);
    }
    return corners;
  }
}
