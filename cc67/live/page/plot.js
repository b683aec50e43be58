// Curves on a canvas: lanes one above the other, each with its own scale, over one axis of time.

import { Pen } from "./pen.js";

const COLORS = {
  light: ["#1a5fd0", "#c2410c", "#0f766e", "#9333ea", "#b91c1c", "#4d7c0f", "#be185d", "#0e7490"],
  dark: ["#6ea8ff", "#ff9d5c", "#4fd1c5", "#c79bff", "#ff8a80", "#b5e36b", "#ff8ac4", "#67d8ef"],
};
const LEFT = 62, RIGHT = 10, BOTTOM = 20, GAP = 8, DIGITAL = 26;

export const isDigital = (name) => /^bit\d+$/.test(name);

/** The colour of a signal in the present theme. */
export function color(index) {
  const colors = COLORS[document.documentElement.dataset.theme === "dark" ? "dark" : "light"];
  return colors[index % colors.length];
}

/** What signals of one lane have in common. `dest0` and `pos0` are of one axis; what drives it has another unit. */
export const LANES = {
  "by kind": (name) => name.replace(/\d+$/, ""),
  "by axis": (name) => name.replace(/^(?:dest|pos|load|enc)(\d)$/, "axis $1"),
  "one each": (name) => name,
  "one lane": () => "",
};

/** The lanes of some signals; those for which `kindOf` says the same share one. */
export function lanesOf(names, kindOf = LANES["by kind"]) {
  const lanes = [];
  names.forEach((name, signal) => {
    const kind = kindOf(name);
    const lane = isDigital(name) ? undefined : lanes.find((lane) => !lane.digital && lane.kind === kind);
    if (lane) lane.signals.push(signal);
    else lanes.push({ kind, digital: isDigital(name), signals: [signal] });
  });
  return lanes;
}

/** A canvas with as many pixels as the screen shows. */
export function fit(canvas) {
  const scale = devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
  if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  return { context, width, height };
}

/** Where things are: times and values to pixels. */
export class Layout {
  constructor(history, from, to, width, height, kindOf) {
    Object.assign(this, { history, from, to, width, height, left: LEFT, right: width - RIGHT });
    this.first = Math.max(0, history.find(from) - 1);
    this.last = Math.min(history.count - 1, history.find(to));
    this.lanes = lanesOf(history.names, kindOf);
    const digital = this.lanes.filter((lane) => lane.digital).length;
    const analog = this.lanes.length - digital;
    const free = height - BOTTOM - digital * DIGITAL - GAP * this.lanes.length;
    let top = GAP / 2;
    for (const lane of this.lanes) {
      lane.top = top;
      lane.height = lane.digital ? DIGITAL - 6 : Math.max(24, free / analog);
      top += lane.height + GAP + (lane.digital ? 6 : 0);
      [lane.low, lane.high] = lane.digital ? [0, 1] : this.#range(lane);
    }
  }

  #range(lane) {
    let low = Infinity, high = -Infinity;
    const step = Math.max(1, Math.floor((this.last - this.first) / 20000));
    for (let row = this.first; row <= this.last; row += step) {
      for (const signal of lane.signals) {
        const value = this.history.value(row, signal);
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (!(low <= high)) return [0, 1];
    const margin = (high - low) * 0.06 || Math.max(1, Math.abs(high) * 0.01);
    return [low - margin, high + margin];
  }

  x(tick) {
    return this.left + ((tick - this.from) / (this.to - this.from)) * (this.right - this.left);
  }

  tickAt(x) {
    return this.from + ((x - this.left) / (this.right - this.left)) * (this.to - this.from);
  }

  y(lane, value) {
    return lane.top + lane.height * (1 - (value - lane.low) / (lane.high - lane.low));
  }
}

/** Draws everything but cursors. */
export function draw(context, layout, style) {
  context.clearRect(0, 0, layout.width, layout.height);
  context.font = "11px system-ui, sans-serif";
  drawTimes(context, layout, style);
  for (const lane of layout.lanes) {
    if (!lane.digital) drawScale(context, layout, lane, style);
    context.save();
    context.beginPath();
    context.rect(layout.left, lane.top - 2, layout.right - layout.left, lane.height + 4);
    context.clip();
    for (const signal of lane.signals) drawCurve(context, layout, lane, signal);
    context.restore();
    drawNames(context, layout, lane);
  }
}

/** Round steps, so that labels are short. */
export function steps(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= raw) ?? raw;
  const values = [];
  for (let value = Math.ceil(low / step) * step; value <= high + step * 1e-9; value += step) values.push(Math.abs(value) < step / 1e6 ? 0 : value);
  return { values, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

function drawTimes(context, layout, style) {
  const seconds = 90e-6;
  const { values, digits } = steps(layout.from * seconds, layout.to * seconds, Math.max(2, layout.width / 110));
  context.strokeStyle = style.line;
  context.fillStyle = style.quiet;
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  for (const value of values) {
    const x = Math.round(layout.x(value / seconds)) + 0.5;
    if (x < layout.left || x > layout.right) continue;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, layout.height - BOTTOM + 3);
    context.stroke();
    context.fillText(`${value.toFixed(digits)} s`, x, layout.height - 5);
  }
}

function drawScale(context, layout, lane, style) {
  const { values, digits } = steps(lane.low, lane.high, Math.max(1, lane.height / 34));
  context.strokeStyle = style.line;
  context.fillStyle = style.quiet;
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const value of values) {
    const y = Math.round(layout.y(lane, value)) + 0.5;
    context.beginPath();
    context.moveTo(layout.left, y);
    context.lineTo(layout.right, y);
    context.stroke();
    const text = Math.abs(value) >= 1e6 ? value.toExponential(1) : value.toFixed(digits);
    context.fillText(text, layout.left - 6, y);
  }
}

function drawNames(context, layout, lane) {
  context.textBaseline = "top";
  context.textAlign = "left";
  let x = lane.digital ? 4 : layout.left + 6;
  for (const signal of lane.signals) {
    context.fillStyle = color(signal);
    const name = layout.history.names[signal];
    context.fillText(name, x, lane.top + (lane.digital ? 4 : 2));
    x += context.measureText(name).width + 12;
  }
}

/** A curve; where there are more samples than pixels, what each column of pixels spans. */
function drawCurve(context, layout, lane, signal) {
  const { history, first, last } = layout;
  if (last < first) return;
  context.strokeStyle = color(signal);
  context.lineWidth = 1.4;
  context.lineJoin = "bevel";
  context.beginPath();
  const pen = new Pen(context), scale = devicePixelRatio || 1;
  let column = null, low = 0, high = 0, x = 0, y = 0, before = null;
  const flush = () => {
    if (column === null) return;
    const [from, to] = before === null || before < y ? [low, high] : [high, low];
    const turns = before === null || low < Math.min(before, y) || high > Math.max(before, y);
    if (turns && low !== high) {
      pen.to(x, from);
      pen.to(x, to);
    }
    pen.to(x, y);
    before = y;
  };
  for (let row = first; row <= last; row++) {
    const [nextX, nextY] = [layout.x(history.tick(row)), layout.y(lane, history.value(row, signal))];
    const at = Math.round(nextX * scale);
    if (at === column) {
      low = Math.min(low, nextY);
      high = Math.max(high, nextY);
      // An edge of a bit stays upright.
      if (!lane.digital) x = nextX;
    } else {
      flush();
      if (lane.digital && before !== null) pen.to(nextX, before);
      [column, low, high, x] = [at, nextY, nextY, nextX];
    }
    y = nextY;
  }
  flush();
  pen.end();
  context.stroke();
  context.lineWidth = 1;
}
