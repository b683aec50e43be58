// The machine seen from above, from a side, or turned: the way of the tool, soft limits and switches where they are.

import { el, head, short } from "./dom.js";
import { color, fit, steps } from "./plot.js";
import { Trail } from "./trail.js";

const VIEWS = { XY: [0, 1], XZ: [0, 2], YZ: [1, 2], "3D": null };

export function mountPath(section, link) {
  const view = el("select", { "aria-label": "View", onchange: request }, ...Object.keys(VIEWS).map((name) => el("option", {}, name)));
  const choices = ["X", "Y", "Z"].map((letter) => el("select", { "aria-label": `${letter} is axis`, title: `The axis that is drawn as ${letter}`, onchange: clear }));
  head(section, view, el("span", { className: "grow" }), ...choices.map((choice, index) => el("label", { className: "quiet" }, "XYZ"[index], choice)), el("button", { type: "button", "aria-label": "Clear path", onclick: clear }, "Clear"));
  const canvas = el("canvas", { className: "plot", role: "img", "aria-label": "Tool path", tabIndex: 0 });
  const where = el("p", { className: "readout mono" });
  section.append(el("div", { className: "canvas" }, canvas), where);
  const trail = new Trail();
  let axes = [], switches = [], latest = null, dirty = false;
  const turn = { around: -0.6, up: 0.5 };

  function clear() {
    trail.clear();
    request();
  }

  function request() {
    if (dirty) return;
    dirty = true;
    requestAnimationFrame(() => {
      dirty = false;
      paint();
    });
  }

  const chosen = () => choices.map((choice) => Number(choice.value));
  const position = (frame, axis) => (frame.axes[axis].hasFeedback ? frame.axes[axis].position : frame.axes[axis].dest);

  /** What there is to be seen, in the coordinates of the machine. */
  function bounds() {
    const { box } = trail;
    const widen = (dimension, value) => {
      box[dimension][0] = Math.min(box[dimension][0], value);
      box[dimension][1] = Math.max(box[dimension][1], value);
    };
    chosen().forEach((axis, dimension) => {
      const { negative, positive } = latest.axes[axis];
      if (negative > -1e29) widen(dimension, negative);
      if (positive < 1e29) widen(dimension, positive);
      for (const one of switches) {
        if (one.axis === axis) for (const edge of [one.from, one.to]) if (edge !== null) widen(dimension, edge);
      }
    });
    // What has no width of its own gets some, so that a line along an axis stands in a plane.
    const widest = Math.max(2, ...box.map(([low, high]) => (low <= high ? high - low : 0)));
    return box.map(([low, high]) => {
      if (!(low <= high)) [low, high] = [0, 0];
      const missing = Math.max(0, widest / 3 - (high - low)) / 2;
      return [low - missing, high + missing];
    });
  }

  /** A point of the machine on the canvas. */
  function projection(box, width, height, left) {
    const flat = VIEWS[view.value];
    const middle = box.map(([low, high]) => (low + high) / 2);
    const project = flat
      ? (point) => [point[flat[0]] - middle[flat[0]], point[flat[1]] - middle[flat[1]]]
      : (point) => {
          const [x, y, z] = point.map((value, index) => value - middle[index]);
          const [cos, sin] = [Math.cos(turn.around), Math.sin(turn.around)];
          return [x * cos - y * sin, (x * sin + y * cos) * Math.sin(turn.up) + z * Math.cos(turn.up)];
        };
    const corners = [];
    for (const x of box[0]) for (const y of box[1]) for (const z of box[2]) corners.push(project([x, y, z]));
    const [w, h] = [0, 1].map((side) => Math.max(1e-9, 2 * Math.max(...corners.map((corner) => Math.abs(corner[side])))));
    const scale = Math.min((width - left - 24) / w, (height - 50) / h);
    return (point) => {
      const [x, y] = project(point);
      return [(width + left - 24) / 2 + x * scale, height / 2 - y * scale];
    };
  }

  /** What the labels at the left take. */
  function margin(context, box) {
    const { values, digits } = steps(...box[(VIEWS[view.value] ?? [0, 1])[1]], 4);
    return Math.max(24, ...values.map((value) => context.measureText(value.toFixed(digits)).width + 12));
  }

  function paint() {
    const { context, width, height } = fit(canvas);
    if (!width || !height || !latest || !axes.length) return;
    const css = getComputedStyle(document.documentElement);
    const [line, quiet, bad] = ["--line", "--quiet", "--bad"].map((name) => css.getPropertyValue(name));
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif";
    const box = bounds(), at = projection(box, width, height, margin(context, box));
    grid(context, box, at, line, quiet);
    edges(context, box, at, bad);
    trail.draw(context, at, [view.value, turn, box], color(0));
    const tool = at(chosen().map((axis) => position(latest, axis)));
    context.fillStyle = bad;
    context.beginPath();
    context.arc(...tool, 4.5, 0, 2 * Math.PI);
    context.fill();
  }

  function grid(context, box, at, line, quiet) {
    const flat = VIEWS[view.value] ?? [0, 1];
    const names = chosen().map((axis) => axes[axis].name);
    const rest = [0, 1, 2].find((dimension) => !flat.includes(dimension));
    const point = (a, b) => {
      const point = [0, 0, 0];
      [point[flat[0]], point[flat[1]], point[rest]] = [a, b, box[rest][0]];
      return at(point);
    };
    context.strokeStyle = line;
    context.fillStyle = quiet;
    context.textBaseline = "middle";
    flat.forEach((dimension, index) => {
      const other = box[flat[1 - index]];
      const { values, digits } = steps(...box[dimension], 4);
      for (const value of values) {
        const ends = other.map((end) => (index ? point(end, value) : point(value, end)));
        context.beginPath();
        context.moveTo(...ends[0]);
        context.lineTo(...ends[1]);
        context.stroke();
        context.textAlign = index ? "right" : "center";
        context.fillText(value.toFixed(digits), ends[0][0] - (index ? 5 : 0), ends[0][1] + (index ? 0 : 10));
      }
      const end = index ? point(other[0], box[dimension][1]) : point(box[dimension][1], other[0]);
      context.textAlign = "left";
      context.fillText(names[dimension], end[0] + 5, end[1] + (index ? -8 : 0));
    });
  }

  /** Soft limits and the edges of switches. */
  function edges(context, box, at, bad) {
    const flat = VIEWS[view.value] ?? [0, 1];
    chosen().forEach((axis, dimension) => {
      if (!flat.includes(dimension)) return;
      const other = flat.find((one) => one !== dimension);
      const { negative, positive } = latest.axes[axis];
      const lines = [negative, positive].filter((value) => Math.abs(value) < 1e29).map((value) => [value, [], bad]);
      for (const one of switches.filter((one) => one.axis === axis)) {
        const isOn = latest.bit(one.bit) === 1;
        for (const edge of [one.from, one.to]) if (edge !== null) lines.push([edge, isOn ? [] : [2, 4], color(1)]);
      }
      for (const [value, dash, stroke] of lines) {
        const point = (end) => {
          const point = box.map(([low]) => low);
          [point[dimension], point[other]] = [value, end];
          return at(point);
        };
        context.strokeStyle = stroke;
        context.setLineDash(dash);
        context.beginPath();
        context.moveTo(...point(box[other][0]));
        context.lineTo(...point(box[other][1]));
        context.stroke();
        context.setLineDash([]);
      }
    });
  }

  canvas.addEventListener("pointermove", (event) => {
    if (!(event.buttons & 1)) return;
    turn.around += event.movementX / 120;
    turn.up = Math.max(-1.5, Math.min(1.5, turn.up + event.movementY / 120));
    request();
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (!step) return;
    event.preventDefault();
    turn.around += step[0];
    turn.up += step[1];
    request();
  });
  addEventListener("resize", request);
  addEventListener("themechange", request);
  link.on("hello", (hello) => {
    const isNew = JSON.stringify(axes) !== JSON.stringify(hello.axes);
    [axes, switches] = [hello.axes, hello.switches];
    if (!isNew) return;
    choices.forEach((choice, index) => {
      choice.replaceChildren(...axes.map((axis) => el("option", { value: String(axis.axis), selected: axis.axis === index, title: axis.name }, axis.name.replace(/^Axis (\d+)$/, "$1"))));
    });
    clear();
  });
  // A board that was switched on again begins at tick 0.
  link.on("state", (isThere) => { if (isThere) clear(); });
  link.on("cut", ({ tick }) => trail.cut(tick));
  link.on("frame", (frame) => {
    const before = latest?.tick;
    latest = frame;
    if (!frame.past && trail.add(frame.tick, chosen().map((axis) => position(frame, axis)))) request();
    else if (frame.tick !== before) request();
    where.textContent = chosen().map((axis) => `${axes[axis]?.name ?? axis} ${short(position(frame, axis))}`).join("   ");
  });
}
