// The scope: signals over time, with trigger, cursors, pause and export.

import { attribute, el, head, say, short } from "./dom.js";
import { asCsv, asVcd, save } from "./export.js";
import { History } from "./history.js";
import { color, draw, fit, LANES, Layout } from "./plot.js";

const SECOND = 1 / 90e-6;

export function mountScope(section, link) {
  const scope = new Scope(section, link);
  section.scope = scope;
}

class Scope {
  history = new History();
  layout = null;
  #cursors = [];
  #held = null;
  #tick = 0;
  #dirty = false;

  constructor(section, link) {
    this.#build(section, link);
    link.on("signals", (message) => {
      this.history.reset(message.names, message.generation);
      if (document.activeElement !== this.list) this.list.value = message.list;
      this.wrong.hidden = !message.wrong.length;
      this.wrong.replaceChildren(...message.wrong.map(({ name, text }) => el("span", {}, el("code", {}, name), `: ${text}`)));
      this.trigger.replaceChildren(...["none", ...message.names].map((name) => el("option", { value: name }, name)));
      this.#cursors = [];
      this.#request();
    });
    link.on("frame", (frame) => {
      this.history.add(frame);
      this.#tick = frame.tick;
      if (this.#held === null) this.#request();
    });
    link.on("cut", ({ tick }) => this.history.cut(tick));
    addEventListener("resize", () => this.#request());
    addEventListener("themechange", () => this.#request());
  }

  #build(section, link) {
    this.list = el("input", { type: "text", "aria-label": "Signals", title: "Items and C expressions, separated by commas: dest0, bit136, count * 2", spellcheck: false, size: 22 });
    this.list.addEventListener("change", () => link.ask("watch", { list: this.list.value }));
    this.span = el("select", { "aria-label": "Time shown", onchange: () => this.#request() },
      ...[0.01, 0.1, 1, 2, 5, 10, 30, 120, 600].map((seconds) => el("option", { value: String(seconds), selected: seconds === 5 }, `${seconds} s`)));
    this.trigger = el("select", { "aria-label": "Trigger" }, el("option", { value: "none" }, "none"));
    this.edge = el("select", { "aria-label": "Trigger edge" }, el("option", { value: "1" }, "↑"), el("option", { value: "-1" }, "↓"));
    this.level = el("input", { type: "number", value: "0.5", step: "any", "aria-label": "Trigger level", style: "width:5em" });
    for (const control of [this.trigger, this.edge, this.level]) control.addEventListener("input", () => this.#request());
    this.pause = el("button", { type: "button", "aria-pressed": "false", onclick: () => this.#hold() }, "Hold");
    const files = (name, make) => el("button", { type: "button", "aria-label": `Save ${name}`, onclick: () => make() }, name);
    this.list.classList.add("grow");
    this.lanes = el("select", { "aria-label": "Lanes", title: "Signals that share a lane and its scale", onchange: () => this.#request() },
      ...Object.keys(LANES).map((name) => el("option", {}, name)));
    this.wrong = el("p", { className: "wrong", role: "status", hidden: true });
    head(section, this.list, this.span, this.lanes, this.pause);
    const more = el("div", { className: "tools" },
      el("label", { className: "quiet" }, "Trigger ", this.trigger), this.edge, this.level, el("span", { className: "grow" }),
      files("CSV", () => save("scope.csv", "text/csv", asCsv(this.history, ...this.#rows()))),
      files("VCD", () => save("scope.vcd", "text/plain", asVcd(this.history, ...this.#rows()))),
      files("PNG", () => this.canvas.toBlob((blob) => save("scope.png", "image/png", blob))));
    this.canvas = el("canvas", { className: "plot", role: "img", "aria-label": "Signals over time", tabIndex: 0 });
    this.readout = el("p", { className: "readout mono" });
    section.append(this.wrong, el("div", { className: "canvas" }, this.canvas), this.readout, more);
    this.canvas.addEventListener("pointerdown", (event) => this.#place(event));
    this.canvas.addEventListener("dblclick", () => {
      this.#cursors = [];
      this.#request();
    });
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  #rows() {
    const { layout } = this;
    return layout ? [layout.first, layout.last] : [0, -1];
  }

  #hold() {
    this.#held = this.#held === null ? this.#tick : null;
    attribute(this.pause, "aria-pressed", this.#held !== null);
    this.#request();
  }

  /** Draws once before the next picture. */
  #request() {
    if (this.#dirty) return;
    this.#dirty = true;
    requestAnimationFrame(() => {
      this.#dirty = false;
      this.#draw();
    });
  }

  /** The end of what is shown: now, or half a span after the last time that the trigger was met. */
  #end(span) {
    const now = this.#held ?? this.#tick;
    const signal = this.history.names.indexOf(this.trigger.value);
    if (signal < 0) return Math.max(now, span);
    const [sign, level] = [Number(this.edge.value), this.level.valueAsNumber];
    const over = (row) => sign * (this.history.value(row, signal) - level) >= 0;
    for (let row = Math.min(this.history.count, this.history.find(now - span / 2)) - 1; row > 0; row--) {
      if (over(row) && !over(row - 1)) return this.history.tick(row) + span / 2;
    }
    return Math.max(now, span);
  }

  #draw() {
    const { context, width, height } = fit(this.canvas);
    if (!width || !height) return;
    const css = getComputedStyle(document.documentElement);
    const style = { line: css.getPropertyValue("--line"), quiet: css.getPropertyValue("--quiet"), ink: css.getPropertyValue("--ink") };
    const span = Number(this.span.value) * SECOND;
    const end = this.#end(span);
    this.layout = new Layout(this.history, end - span, end, width, height, LANES[this.lanes.value]);
    draw(context, this.layout, style);
    this.#drawCursors(context, style);
    this.#say();
  }

  #drawCursors(context, style) {
    this.#cursors.forEach((tick, index) => {
      const x = Math.round(this.layout.x(tick)) + 0.5;
      context.strokeStyle = context.fillStyle = style.ink;
      context.setLineDash([4, 3]);
      context.beginPath();
      context.moveTo(x, 0);
      context.lineTo(x, this.layout.height - 20);
      context.stroke();
      context.setLineDash([]);
      context.textAlign = "left";
      context.textBaseline = "alphabetic";
      context.fillText("AB"[index], x + 3, this.layout.height - 23);
    });
  }

  /** The value of each signal at the cursors, or now. */
  #say() {
    const { history } = this;
    if (!history.count) return say(this.readout, "no samples yet");
    const at = (tick) => Math.max(0, Math.min(history.count - 1, history.find(tick + 1) - 1));
    const rows = (this.#cursors.length ? this.#cursors : [this.layout.to]).map(at);
    const times = rows.map((row, index) => `${this.#cursors.length ? `${"AB"[index]} ` : ""}${(history.tick(row) * 90e-6).toFixed(4)} s`);
    if (rows.length === 2) times.push(`B−A ${((history.tick(rows[1]) - history.tick(rows[0])) * 90e-6).toFixed(4)} s`);
    const values = history.names.map((name, signal) => {
      const span = el("span", {}, `${name} ${rows.map((row) => short(history.value(row, signal))).join(" → ")}`);
      span.style.color = color(signal);
      return span;
    });
    this.readout.replaceChildren(times.join("  "), ...values);
  }

  #place(event) {
    if (!this.layout) return;
    const x = (moved) => this.layout.tickAt(moved.clientX - this.canvas.getBoundingClientRect().left);
    const tick = x(event);
    const near = this.#cursors.findIndex((cursor) => Math.abs(this.layout.x(cursor) - this.layout.x(tick)) < 8);
    const index = near >= 0 ? near : this.#cursors.length < 2 ? this.#cursors.length : 1;
    const move = (moved) => {
      this.#cursors[index] = x(moved);
      this.#request();
    };
    move(event);
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.addEventListener("pointermove", move);
    this.canvas.addEventListener("pointerup", () => this.canvas.removeEventListener("pointermove", move), { once: true });
  }

  /** Arrows move the last cursor, A and B set them. */
  #key(event) {
    if (!this.layout) return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step) {
      const last = Math.max(0, this.#cursors.length - 1);
      this.#cursors[last] = (this.#cursors[last] ?? this.layout.to) + step * (this.layout.to - this.layout.from) / (event.shiftKey ? 10 : 200);
    } else if (event.key === "Escape") this.#cursors = [];
    else if (event.key === "b" && this.#cursors.length) this.#cursors[1] = this.#cursors[0];
    else return;
    event.preventDefault();
    this.#request();
  }
}
