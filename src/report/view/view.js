// The view of a bed that turns: spheres as shaded discs with their own depth, walls translucent, in WebGL2.
// `bedView(figure)` reads the element `.bed-data` of a figure and draws on its canvas; `figure.reload()` reads it again.
"use strict";

const SPHERES = `#version 300 es
layout(location=0) in vec3 centre;
layout(location=1) in float size;
layout(location=2) in float value;
uniform mat3 turn;
uniform vec3 low, span, middle;
uniform vec2 radii, zoom, pan;
uniform vec4 cut;
uniform float reach, pixel, dots;
out vec2 place;
flat out vec2 depth;
flat out float shade;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  vec3 spot = low + span * centre;
  float radius = radii.x + radii.y * size;
  vec3 at = turn * (spot - middle);
  depth = vec2(at.z, radius) / reach;
  shade = value;
  radius = max(radius, pixel);
  // Dots are faster where spheres are many and small; their corners come with each fragment.
  if (dots > 0.0) corner = vec2(0);
  place = corner;
  gl_PointSize = 2.0 * radius * dots;
  gl_Position = vec4((at.xy + radius * corner - pan) * zoom, -at.z / reach, 1);
  bool beside = cut.xyz != vec3(0) && abs(dot(cut.xyz, spot) - cut.w) > 2.0 * radius;
  if (beside) gl_Position = vec4(2, 2, 2, 1);
}`;
const BALL = `#version 300 es
precision highp float;
in vec2 place;
flat in vec2 depth;
flat in float shade;
uniform vec3 stops[6];
uniform float dots;
out vec4 colour;
void main() {
  vec2 corner = dots > 0.0 ? vec2(2, -2) * (gl_PointCoord - 0.5) : place;
  float square = dot(corner, corner);
  if (square > 1.0) discard;
  float height = sqrt(1.0 - square);
  gl_FragDepth = 0.5 - 0.5 * (depth.x + depth.y * height);
  float at = clamp(shade / 254.0, 0.0, 1.0) * 5.0;
  int lower = min(int(at), 4);
  vec3 own = shade > 254.5 ? vec3(0.55) : mix(stops[lower], stops[lower + 1], at - float(lower));
  float light = max(dot(vec3(corner, height), vec3(-0.35, 0.5, 0.79)), 0.0);
  colour = vec4(own * (0.62 + 0.43 * light) * smoothstep(-0.1, 0.45, height), 1);
}`;
const SURFACE = `#version 300 es
layout(location=0) in vec3 place;
uniform mat3 turn;
uniform vec3 low, span, middle;
uniform vec2 zoom, pan;
uniform float reach;
out vec3 at;
void main() {
  at = turn * (low + span * place - middle);
  gl_Position = vec4((at.xy - pan) * zoom, -at.z / reach, 1);
}`;
const GLASS = `#version 300 es
precision highp float;
in vec3 at;
uniform vec3 ink;
uniform float line;
out vec4 colour;
void main() {
  float facing = abs(normalize(cross(dFdx(at), dFdy(at))).z);
  colour = vec4(ink, line > 0.0 ? line : mix(0.22, 0.06, facing));
}`;

// So many spheres are many, and so many pixels wide they are small.
const [MANY, SMALL] = [20000, 40];

function bedView(figure) {
  const part = (name) => figure.querySelector(name);
  const canvas = part("canvas");
  // What was chosen stays where the page brings newer data.
  const start = { yaw: -0.5, pitch: 0.25, grow: 1, pan: [0, 0] };
  const now = { ...start, frame: Infinity, column: null, walls: true, slice: -1, at: 0.5, playing: 0 };
  const reduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let data, bytes, gl, programs, waiting = false;

  function fail(text) {
    part(".view-message").textContent = text;
    figure.classList.add("without");
  }

  function program(vertex, fragment) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getProgramInfoLog(made) || "a shader does not compile");
    }
    const uniforms = {};
    for (let k = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS) - 1; k >= 0; k--) {
      const name = gl.getActiveUniform(made, k).name.replace("[0]", "");
      uniforms[name] = gl.getUniformLocation(made, name);
    }
    return { made, uniforms };
  }

  function open() {
    // Several samples a pixel smooth lines only, and cost much where spheres are many.
    const antialias = data.frames.every((frame) => frame.count < MANY);
    gl = canvas.getContext("webgl2", { antialias, preserveDrawingBuffer: true });
    if (!gl) return;
    programs = [program(SPHERES, BALL), program(SURFACE, GLASS)];
  }

  function upload() {
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
  }

  function load() {
    const chosen = data && data.columns[now.column]?.label;
    const last = !data || now.frame >= data.frames.length - 1;
    data = JSON.parse(part(".bed-data").textContent);
    bytes = Uint8Array.from(atob(data.bytes), (letter) => letter.charCodeAt(0));
    const same = data.columns.findIndex((column) => column.label === chosen);
    now.column = same >= 0 ? same : data.first;
    now.frame = last ? data.frames.length - 1 : now.frame;
    part(".view-column").replaceChildren(
      ...data.columns.map((column, k) => new Option(column.label, k, false, k === now.column)));
    part(".view-time").max = data.frames.length - 1;
    figure.classList.toggle("still", data.frames.length < 2);
    const stops = data.stops.map((stop) => `rgb(${stop.join(" ")})`);
    part(".view-scale i").style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
    if (!gl) open();
    if (!gl) {
      fail("This browser has no WebGL2, which the turning view needs. The pictures of this page show the same bed.");
      return false;
    }
    upload();
    show();
    return true;
  }

  function turned() {
    const [s, c, t, d] = [Math.sin(now.yaw), Math.cos(now.yaw), Math.sin(now.pitch), Math.cos(now.pitch)];
    // Rows: to the right, up, towards the eye; at rest x is right, z up, and one looks along y.
    return [[c, s, 0], [-s * t, c * t, d], [s * d, -c * d, t]];
  }

  /// Half the room in m that the box takes to the right, up and in depth, as it is seen at rest.
  function extent() {
    const span = data.high.map((high, axis) => high - data.low[axis]);
    const kept = [now.yaw, now.pitch];
    [now.yaw, now.pitch] = [start.yaw, start.pitch];
    const half = turned().map((row) => row.reduce((sum, x, axis) => sum + Math.abs(x) * span[axis], 0) / 2);
    [now.yaw, now.pitch] = kept;
    return [half[0] + data.radii[1], half[1] + data.radii[1], Math.hypot(...span) / 2 + data.radii[1]];
  }

  /// Pixels of the screen a metre.
  function scale() {
    const [wide, tall] = extent();
    return 0.94 * now.grow * Math.min(canvas.clientWidth / wide, canvas.clientHeight / tall) / 2;
  }

  function draw() {
    waiting = false;
    const sharp = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * sharp)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const each = scale();
    const zoom = [2 * each / canvas.clientWidth, 2 * each / canvas.clientHeight];
    const span = data.high.map((high, axis) => high - data.low[axis]);
    const rows = turned();
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const use = ({ made, uniforms: u }) => {
      gl.useProgram(made);
      gl.uniformMatrix3fv(u.turn, false, [0, 1, 2].flatMap((column) => rows.map((row) => row[column])));
      gl.uniform3fv(u.low, data.low);
      gl.uniform3fv(u.span, span);
      gl.uniform3fv(u.middle, data.low.map((low, axis) => low + span[axis] / 2));
      gl.uniform2fv(u.zoom, zoom);
      gl.uniform2fv(u.pan, now.pan);
      gl.uniform1f(u.reach, 1.02 * extent()[2]);
      return u;
    };
    const attribute = (place, size, kind, normal, offset, each) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, kind, normal, 0, offset);
      gl.vertexAttribDivisor(place, each);
    };
    const frame = data.frames[now.frame];
    let u = use(programs[0]);
    const along = [0, 1, 2].map((axis) => Number(axis === now.slice));
    const cut = now.slice < 0 ? 0 : data.low[now.slice] + now.at * span[now.slice];
    gl.uniform4f(u.cut, ...along, cut);
    gl.uniform2f(u.radii, data.radii[0], data.radii[1] - data.radii[0]);
    gl.uniform1f(u.pixel, 0.6 / each);
    gl.uniform3fv(u.stops, data.stops.flatMap((stop) => stop.map((level) => level / 255)));
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    const dots = frame.count > MANY && 2 * data.radii[1] * each * sharp < SMALL;
    gl.uniform1f(u.dots, dots ? each * sharp : 0);
    attribute(0, 3, gl.UNSIGNED_SHORT, true, frame.positions, dots ? 0 : 1);
    attribute(1, 1, gl.UNSIGNED_BYTE, true, frame.radii, dots ? 0 : 1);
    attribute(2, 1, gl.UNSIGNED_BYTE, false, frame.values[now.column], dots ? 0 : 1);
    if (dots) gl.drawArrays(gl.POINTS, 0, frame.count);
    else if (frame.count) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, frame.count);
    const walls = data.walls;
    if (!now.walls || !walls) return;
    u = use(programs[1]);
    [1, 2].forEach((place) => gl.disableVertexAttribArray(place));
    attribute(0, 3, gl.UNSIGNED_SHORT, true, walls.points, 0);
    const ink = getComputedStyle(canvas).color.match(/[\d.]+/g).slice(0, 3);
    gl.uniform3fv(u.ink, ink.map((level) => level / 255));
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.uniform1f(u.line, 0);
    gl.drawElements(gl.TRIANGLES, walls.corners, gl.UNSIGNED_SHORT, walls.triangles);
    gl.uniform1f(u.line, 0.6);
    gl.drawElements(gl.LINES, walls.ends, gl.UNSIGNED_SHORT, walls.edges);
    gl.depthMask(true);
  }

  function show() {
    const { columns, frames } = data;
    part(".view-time").value = now.frame;
    part(".view-clock").textContent = frames[now.frame].time;
    part(".view-play").textContent = now.playing ? "Pause" : "Play";
    part(".view-place").hidden = now.slice < 0;
    part(".view-ticks").replaceChildren(...columns[now.column].ticks.map((text) => {
      const tick = document.createElement("span");
      tick.textContent = text;
      return tick;
    }));
    part(".view-label").textContent = columns[now.column].label;
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(draw);
    }
  }

  function play(on) {
    clearInterval(now.playing);
    now.playing = on && data.frames.length > 1
      ? setInterval(() => { step(1); }, Math.max(reduced ? 500 : 100, 4000 / data.frames.length)) : 0;
    show();
  }

  function step(by) {
    const count = data.frames.length;
    now.frame = (now.frame + by + count) % count;
    show();
  }

  function turn(right, down) {
    now.yaw -= right;
    now.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, now.pitch + down));
    show();
  }

  function shift(right, down) {
    const each = scale();
    now.pan = [now.pan[0] - right / each, now.pan[1] + down / each];
    show();
  }

  function grow(factor) {
    now.grow = Math.max(0.2, Math.min(60, now.grow * factor));
    show();
  }

  function reset() {
    Object.assign(now, start, { pan: [0, 0] });
    show();
  }

  function listen() {
    const fingers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const [right, down] = [event.clientX - before[0], event.clientY - before[1]];
      const other = [...fingers].find(([id]) => id !== event.pointerId);
      if (other) {
        const away = ([x, y]) => Math.hypot(x - other[1][0], y - other[1][1]);
        grow(away([event.clientX, event.clientY]) / Math.max(away(before), 1));
        shift(right / 2, down / 2);
      } else if (event.shiftKey || event.buttons & 2) {
        shift(right, down);
      } else {
        turn(right * 0.008, down * 0.008);
      }
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    const lift = (event) => fingers.delete(event.pointerId);
    canvas.addEventListener("pointerup", lift);
    canvas.addEventListener("pointercancel", lift);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // The wheel scrolls the page until the view was clicked.
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      grow(Math.exp(-event.deltaY * 0.0015));
    }, { passive: false });
    const keys = {
      ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0),
      ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
      "+": () => grow(1.15), "=": () => grow(1.15), "-": () => grow(1 / 1.15),
      0: reset, Home: reset, " ": () => play(!now.playing),
      ",": () => step(-1), ".": () => step(1),
    };
    canvas.addEventListener("keydown", (event) => {
      const act = event.ctrlKey || event.metaKey || event.altKey ? null : keys[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    });
    const on = (name, kind, act) => part(name).addEventListener(kind, (event) => { act(event.target); show(); });
    on(".view-column", "change", (menu) => { now.column = Number(menu.value); });
    on(".view-slice", "change", (menu) => { now.slice = Number(menu.value); });
    on(".view-place", "input", (slider) => { now.at = Number(slider.value) / 100; });
    on(".view-walls", "change", (box) => { now.walls = box.checked; });
    on(".view-time", "input", (slider) => {
      now.frame = Number(slider.value);
      play(false);
    });
    on(".view-play", "click", () => play(!now.playing));
    on(".view-reset", "click", reset);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { open(); upload(); show(); });
    new ResizeObserver(show).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
    addEventListener("beforeprint", () => draw());
  }

  try {
    figure.classList.remove("without");
    if (!load()) return;
    figure.reload = load;
    listen();
  } catch (error) {
    fail(`The turning view cannot be drawn: ${error.message}. The pictures of this page show the same bed.`);
  }
}

document.querySelectorAll(".bed-view").forEach(bedView);
