// The gather buffer as curves: numbers of one kind, some of them a sample, read when one asks for it.

import { el, say, short } from "./dom.js";
import { color, fit } from "./plot.js";

export function mountGather(parent, link) {
  const kind = el("select", { "aria-label": "Numbers" }, ...["double", "float", "int"].map((name) => el("option", {}, name)));
  const whole = (label, value, max) => el("input", { type: "number", min: label === "From" ? "0" : "1", max: String(max), step: "1", value: String(value), required: true, "aria-label": `Gather: ${label.toLowerCase()}` });
  const from = whole("From", 0, 1999999), count = whole("Count", 1000, 10000), columns = whole("Columns", 1, 8);
  const form = el("form", { className: "tools" }, kind, el("label", {}, "from ", from), el("label", {}, "count ", count), el("label", {}, "columns ", columns),
    el("button", { type: "submit" }, "Read gather buffer"));
  const canvas = el("canvas", { className: "plot", role: "img", "aria-label": "Gather buffer" });
  const range = el("p", { className: "quiet mono", role: "status" });
  const details = el("details", { className: "gather" }, el("summary", {}, "Gather"), form, el("div", { className: "canvas" }, canvas), range);
  parent.append(details);
  let values = [];

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    link.ask("gather", { from: from.valueAsNumber, count: count.valueAsNumber, kind: kind.value });
  });
  link.on("gather", (message) => {
    values = message.values;
    draw();
  });
  details.addEventListener("toggle", draw);
  addEventListener("resize", draw);
  addEventListener("themechange", draw);

  function draw() {
    if (!details.open) return;
    const { context, width, height } = fit(canvas);
    context.clearRect(0, 0, width, height);
    const known = values.filter((value) => value !== null);
    if (!known.length) return say(range, "");
    let low = Infinity, high = -Infinity;
    for (const value of known) [low, high] = [Math.min(low, value), Math.max(high, value)];
    say(range, `${values.length} numbers, from ${short(low)} to ${short(high)}`);
    const wide = Math.max(1, columns.valueAsNumber || 1), rows = Math.ceil(values.length / wide);
    const x = (row) => 4 + (row / Math.max(1, rows - 1)) * (width - 8);
    const y = (value) => height - 6 - ((value - low) / (high - low || 1)) * (height - 12);
    for (let column = 0; column < wide; column++) {
      context.strokeStyle = color(column);
      context.lineWidth = 1.4;
      context.beginPath();
      let isDown = false;
      for (let row = 0; row < rows; row++) {
        const value = values[row * wide + column];
        if (value === null || value === undefined) { isDown = false; continue; }
        if (isDown) context.lineTo(x(row), y(value));
        else context.moveTo(x(row), y(value));
        isDown = true;
      }
      context.stroke();
    }
  }
}
