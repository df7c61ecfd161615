// The picture by WebGL 2.

const SURFACE_VERTEX = `#version 300 es
in vec3 place;
uniform mat4 both;
out vec3 at;
void main() {
  at = place;
  gl_Position = both * vec4(place, 1.0);
}`;

const SURFACE_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at;
uniform vec4 colour;
uniform vec3 eye, light, along, beside;
uniform float spacing, contrast;
out vec4 shade;
void main() {
  // The normal of the triangle, towards the eye: both sides of a surface are its front.
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  if (dot(n, eye - at) < 0.0) n = -n;
  float bright = 1.0 - contrast + contrast * (0.75 * max(dot(n, light), 0.0) + 0.25 * abs(dot(n, normalize(eye - at))));
  vec3 c = colour.rgb * bright;
  if (spacing > 0.0) {
    vec2 q = vec2(dot(at, along), dot(at, beside)) / spacing;
    vec2 width = max(fwidth(q), 1e-7);
    vec2 near = abs(fract(q - 0.5) - 0.5) / width;
    float line = (1.0 - min(min(near.x, near.y), 1.0)) * clamp(0.35 / max(width.x, width.y) - 1.0, 0.0, 1.0);
    c *= 1.0 - 0.16 * line;
  }
  shade = vec4(c, colour.a);
}`;

const BALL_VERTEX = `#version 300 es
in vec2 corner;
in vec4 ball;
in vec4 tint;
in vec4 orientation;
uniform mat4 view, projection;
uniform float pixel, least;
out vec2 q;
out vec3 centre;
out vec4 colour;
out float radius;
flat out vec4 turn;
flat out mat3 seen;
void main() {
  turn = orientation;
  seen = mat3(view);
  centre = (view * vec4(ball.xyz, 1.0)).xyz;
  // Not smaller than a few pixels, so that it can be seen and met.
  radius = max(ball.w, least * tint.a * pixel * -centre.z);
  colour = vec4(tint.rgb, 1.0);
  q = corner * 1.1;
  gl_Position = projection * vec4(centre + vec3(q * radius, 0.0), 1.0);
}`;

const BALL_FRAGMENT = `#version 300 es
precision highp float;
in vec2 q;
in vec3 centre;
in vec4 colour;
in float radius;
flat in vec4 turn;
flat in mat3 seen;
uniform mat4 projection;
uniform vec3 light;
uniform float flatness, marked;
out vec4 shade;
// A seam like a tennis ball's, and one side of it darker, so that any turn is seen: z = 2 (x^2 - y^2) on the ball.
float pattern(vec3 n, float soft) {
  vec3 v = n * seen;
  vec3 p = v - 2.0 * cross(turn.xyz, turn.w * v - cross(turn.xyz, v));
  float side = p.z - 2.0 * (p.x * p.x - p.y * p.y);
  vec3 slope = vec3(-4.0 * p.x, 4.0 * p.y, 1.0);
  float off = side / max(length(slope - dot(slope, p) * p), 0.2);
  float line = (1.0 - smoothstep(0.06, 0.06 + 2.0 * soft, abs(off))) * clamp(1.5 - 6.0 * soft, 0.0, 1.0);
  return mix(mix(0.72, 1.0, smoothstep(-soft, soft, off)), 1.7, line);
}
void main() {
  float far = length(q);
  float soft = fwidth(far);
  float cover = 1.0 - smoothstep(1.0 - soft, 1.0 + soft, far);
  if (cover <= 0.0) discard;
  vec3 n = vec3(q, sqrt(max(1.0 - far * far, 0.0)));
  float bright = mix(0.55 + 0.55 * max(dot(n, light), 0.0), 1.0, flatness);
  if (marked > 0.0) bright *= pattern(n, soft);
  vec4 front = projection * vec4(centre + n * radius, 1.0);
  gl_FragDepth = clamp(0.5 * front.z / front.w + 0.5, 0.0, 1.0);
  shade = vec4(colour.rgb * bright, cover);
}`;

const LINE_VERTEX = `#version 300 es
in vec2 corner;
in vec4 from, to;
uniform mat4 both;
uniform vec2 screen;
uniform float width, now;
out float time;
void main() {
  vec4 a = both * vec4(from.xyz, 1.0);
  vec4 b = both * vec4(to.xyz, 1.0);
  // What lies behind the eye is cut off before it is divided.
  const float least = 1e-6;
  if (a.w < least) a = mix(a, b, clamp((least - a.w) / (b.w - a.w), 0.0, 1.0));
  if (b.w < least) b = mix(b, a, clamp((least - b.w) / (a.w - b.w), 0.0, 1.0));
  vec2 way = (b.xy / b.w - a.xy / a.w) * screen;
  float size = length(way);
  way = size > 0.0 ? way / size : vec2(1.0, 0.0);
  vec4 end = corner.x < 0.0 ? a : b;
  vec2 beside = vec2(-way.y, way.x) * corner.y + way * corner.x * 0.5;
  end.xy += beside * width / screen * end.w;
  // A little nearer than the surface on which it lies; what is past nearer than what is to come, where a ball goes forth and back.
  end.z -= (from.w > now ? 2e-5 : 4e-5) * end.w;
  time = corner.x < 0.0 ? from.w : to.w;
  gl_Position = end;
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
in float time;
uniform vec4 colour;
uniform vec3 later;
uniform float now;
out vec4 shade;
void main() {
  shade = vec4(time > now ? later : colour.rgb, colour.a);
}`;

class WebGLPicture {
  // Throws where there is no WebGL 2.
  constructor(canvas, run) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.run = run;
    this.programs = {
      surface: this.program(SURFACE_VERTEX, SURFACE_FRAGMENT),
      ball: this.program(BALL_VERTEX, BALL_FRAGMENT),
      line: this.program(LINE_VERTEX, LINE_FRAGMENT),
    };
    this.square = this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
    this.surfaces = run.surfaces.map((surface) => this.surface(surface));
    this.balls = this.cloud(run.count);
    this.marks = this.cloud(0);
    this.paths = { lines: this.lines(new Float32Array()) };
  }

  program(vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "no program");
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(program, i);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms };
  }

  buffer(data, target = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return buffer;
  }

  // One array with an attribute of `size` numbers at `offset` of each `stride`, in bytes; per instance if `each`.
  attribute({ program }, name, size, stride = 0, offset = 0, each = 1) {
    const { gl } = this;
    const place = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(place, each);
  }

  surface(surface) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    this.buffer(surface.vertices);
    this.attribute(this.programs.surface, "place", 3, 0, 0, 0);
    this.buffer(surface.faces, gl.ELEMENT_ARRAY_BUFFER);
    gl.bindVertexArray(null);
    return { array, count: surface.faces.length, edges: this.lines(withTime(edgesOf(surface))), all: null, of: surface };
  }

  lines(data) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.square);
    this.attribute(this.programs.line, "corner", 2, 0, 0, 0);
    const buffer = this.buffer(data);
    this.attribute(this.programs.line, "from", 4, 32);
    this.attribute(this.programs.line, "to", 4, 32, 16);
    gl.bindVertexArray(null);
    return { array, buffer, count: data.length / 8 };
  }

  // Balls, or marks of one size: twelve numbers each, x, y, z, radius; red, green, blue, share of the least size; and the orientation.
  cloud(count) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.square);
    this.attribute(this.programs.ball, "corner", 2, 0, 0, 0);
    const data = new Float32Array(12 * count);
    const buffer = this.buffer(data);
    this.attribute(this.programs.ball, "ball", 4, 48);
    this.attribute(this.programs.ball, "tint", 4, 48, 16);
    this.attribute(this.programs.ball, "orientation", 4, 48, 32);
    gl.bindVertexArray(null);
    return { array, buffer, data, count };
  }

  setPaths(balls) {
    this.gl.deleteVertexArray(this.paths.lines.array);
    this.gl.deleteBuffer(this.paths.lines.buffer);
    this.paths = { lines: this.lines(stretches(this.run, balls)) };
  }

  setMarks(marks) {
    this.gl.deleteVertexArray(this.marks.array);
    this.gl.deleteBuffer(this.marks.buffer);
    this.marks = this.cloud(marks.length);
    this.markPlaces = marks;
  }

  // Draws the moment `now` of the run with what `look` says.
  draw(camera, now, look) {
    const { gl } = this;
    const { width, height } = gl.canvas;
    const matrices = camera.matrices();
    const { right, above, back } = camera.axes();
    const eye = camera.eye();
    // From over the left shoulder, but fixed in the world as far as the surfaces go.
    const light = unit(add(this.run.up, add(times(camera.east, 0.55), times(camera.north, -0.35))));
    const lightSeen = [dot(light, right), dot(light, above), dot(light, back)];
    gl.viewport(0, 0, width, height);
    gl.clearColor(...look.page, 1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const styles = this.surfaces.map((surface) => styleOf(surface.of, eye, look.surfaces));
    const scene = { matrices, eye, light, look, width, height };
    this.drawSurfaces(scene, styles, "solid");
    this.drawEdges(scene, styles);
    this.drawLines(this.paths.lines, scene, [...look.path, 1], 2 * look.ratio, now, look.later);
    this.fillMarks(now, look);
    this.drawCloud(this.marks, scene, camera, lightSeen, 4, 1);
    this.fillBalls(now, look);
    // The more balls there are, the smaller they may be: they would cover what they bounce on.
    const room = Math.sqrt((width * height) / this.run.count) / look.ratio;
    this.drawCloud(this.balls, scene, camera, lightSeen, clamp(room / 10, 1.2, 4), 0);
    gl.depthMask(false);
    this.drawSurfaces(scene, styles, "glass");
    gl.depthMask(true);
  }

  drawSurfaces({ matrices, eye, light, look }, styles, style) {
    const { gl } = this;
    const { program, uniforms } = this.programs.surface;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.both, false, matrices.both);
    gl.uniform3fv(uniforms.eye, eye);
    gl.uniform3fv(uniforms.light, light);
    gl.uniform1f(uniforms.contrast, look.contrast);
    this.surfaces.forEach((surface, i) => {
      if (styles[i] !== style || surface.count === 0) return;
      gl.uniform4f(uniforms.colour, ...look.palette[i % look.palette.length], style === "glass" ? 0.22 : 1);
      const normal = surface.of.normal;
      gl.uniform1f(uniforms.spacing, normal ? look.spacing : 0);
      const along = normal ? across(normal) : [0, 0, 0];
      gl.uniform3fv(uniforms.along, along);
      gl.uniform3fv(uniforms.beside, normal ? cross(normal, along) : along);
      gl.bindVertexArray(surface.array);
      gl.drawElements(gl.TRIANGLES, surface.count, gl.UNSIGNED_INT, 0);
    });
  }

  drawEdges(scene, styles) {
    this.surfaces.forEach((surface, i) => {
      const all = styles[i] === "lines";
      if (all && !surface.all) surface.all = this.lines(withTime(edgesOf(surface.of, true)));
      this.drawLines(all ? surface.all : surface.edges, scene, [...scene.look.edge, all ? 0.5 : 0.85], scene.look.ratio, 0, scene.look.edge);
    });
  }

  // Of what is later than `now` the colour is `later`: not the same one let through, which would be seen where stretches overlap.
  drawLines(lines, { matrices, width, height }, colour, thickness, now, later) {
    const { gl } = this;
    const { program, uniforms } = this.programs.line;
    if (lines.count === 0) return;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.both, false, matrices.both);
    gl.uniform2f(uniforms.screen, width, height);
    gl.uniform1f(uniforms.width, thickness);
    gl.uniform4fv(uniforms.colour, colour);
    gl.uniform1f(uniforms.now, now);
    gl.uniform3fv(uniforms.later, later);
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  }

  fillBalls(now, look) {
    const { data } = this.balls;
    for (let ball = 0; ball < this.run.count; ball++) {
      const place = this.run.position(ball, now);
      const tint = look.tints[this.run.motionOf(ball, now)];
      const { orientation } = this.run.turning(ball, now);
      data.set([...place, this.run.radius[ball], ...tint, ball === look.ball ? 1.6 : 1, ...orientation], 12 * ball);
    }
  }

  fillMarks(now, look) {
    this.markPlaces?.forEach(({ place, time }, i) => {
      const tint = time <= now ? look.ink : look.faint;
      this.marks.data.set([...place, 0, ...tint, i === look.mark ? 1.7 : 0.75], 12 * i);
    });
  }

  drawCloud(cloud, { matrices, look }, camera, light, least, flatness) {
    const { gl } = this;
    const { program, uniforms } = this.programs.ball;
    if (cloud.count === 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, cloud.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, cloud.data, gl.DYNAMIC_DRAW);
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.view, false, matrices.view);
    gl.uniformMatrix4fv(uniforms.projection, false, matrices.projection);
    gl.uniform3fv(uniforms.light, unit(add(light, [0, 0, 0.6])));
    gl.uniform1f(uniforms.pixel, camera.pixel());
    gl.uniform1f(uniforms.least, least);
    gl.uniform1f(uniforms.flatness, flatness);
    gl.uniform1f(uniforms.marked, this.run.turns && flatness === 0 ? 1 : 0);
    gl.bindVertexArray(cloud.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, cloud.count);
  }
}

// Lines without a time: it is always past.
function withTime(lines) {
  const timed = new Float32Array((lines.length / 3) * 4);
  for (let i = 0; i < lines.length / 3; i++) timed.set([lines[3 * i], lines[3 * i + 1], lines[3 * i + 2], -1], 4 * i);
  return timed;
}

// How a surface is drawn: what hides the balls from this eye is glass, unless the user wants it otherwise.
function styleOf(surface, eye, wanted) {
  if (wanted !== "auto") return wanted;
  if (surface.holds_balls) return "glass";
  if (!surface.normal || surface.vertices.length === 0) return "solid";
  const corner = Array.from(surface.vertices.subarray(0, 3));
  const before = dot(subtract(eye, corner), surface.normal);
  const middle = -dot(corner, surface.normal);
  return before * middle < 0 ? "glass" : "solid";
}
