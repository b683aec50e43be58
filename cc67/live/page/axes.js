// The axes: where each is sent, where it is, how far behind; jog, zero, enable.

import { attribute, el, head, mark, say, short } from "./dom.js";

const TICK = 90e-6;
/** Milliseconds between two words that a jog button is held; the board stops an axis of which it hears nothing for 400. */
const HELD = 100;

export function mountAxes(section, link) {
  const speed = el("input", { type: "range", min: "1", max: "100", value: "25", "aria-label": "Jog speed" });
  const shown = el("output", { className: "mono quiet" }, "25 %");
  speed.addEventListener("input", () => say(shown, `${speed.value} %`));
  head(section, el("span", { className: "grow" }), el("span", { className: "quiet" }, "jog at"), speed, shown);
  const all = el("button", { type: "button", "aria-pressed": "false", title: "Also show unused axes" }, "All");
  section.querySelector(".head").append(all);
  const body = el("tbody");
  section.append(
    el("div", { className: "body" },
      el("table", {}, el("thead", {}, el("tr", {},
        ...["Axis", "Dest", "Position", "Error", "Velocity", "Limits", "Jog"].map((name) => el("th", { scope: "col" }, name)))), body)),
  );
  let rows = [], latest = null;

  all.addEventListener("click", () => {
    attribute(all, "aria-pressed", all.getAttribute("aria-pressed") !== "true");
    if (latest) show(latest);
  });

  function show(frame) {
    latest = frame;
    const every = all.getAttribute("aria-pressed") === "true";
    for (const row of rows) row.show(frame, every);
  }

  link.on("hello", ({ axes }) => {
    if (rows.length && JSON.stringify(axes) === rows.known) return;
    rows = axes.map((axis) => new Row(axis, link, speed));
    rows.known = JSON.stringify(axes);
    body.replaceChildren(...rows.map((row) => row.element));
  });
  link.on("frame", show);
}

class Row {
  #before = null;
  #velocity = 0;
  #vel = 0;
  #enabled = false;
  #used = false;

  constructor(axis, link, speed) {
    this.axis = axis;
    this.link = link;
    this.speed = speed;
    this.cells = ["Dest", "Position", "Error", "Velocity", "Limits"].map((name) => el("td", { className: "mono", "data-label": name }));
    const key = (text, name, more) => el("button", { type: "button", "aria-label": `${name} ${axis.name}`, title: `${name} ${axis.name}`, ...more }, text);
    this.enable = key("Enable", "Enable", { className: "enable", onclick: () => this.#command(this.#enabled ? "DisableAxis" : "EnableAxis") });
    this.element = el("tr", {},
      el("td", { className: "name-cell" }, this.lamp = el("span", { className: "lamp-dot", role: "img" }), el("span", { className: "name" }, axis.name), " ", el("small", { className: "quiet" }, axis.units)),
      ...this.cells,
      el("td", { className: "keys" },
        this.#jog("−", "Jog −", -1), " ", this.#jog("+", "Jog +", 1), " ",
        key("Zero", "Zero", { onclick: () => this.#command("Zero") }), " ", this.enable));
    this.#used = axis.exists && !/^Axis \d+$/.test(axis.name);
  }

  #command(word, argument = "") {
    this.link.ask("command", { line: `${word}${this.axis.axis}${argument}` });
  }

  /** A button that moves the axis for as long as it is held. */
  #jog(text, name, sign) {
    const { axis } = this;
    let held = 0;
    const move = (velocity) => this.link.ask("jog", { axis: axis.axis, velocity });
    const begin = (event) => {
      if (held || !Number.isFinite(this.#vel) || (event.type === "keydown" && event.code !== "Space" && event.code !== "Enter")) return;
      if (event.type === "pointerdown") event.target.setPointerCapture?.(event.pointerId);
      const velocity = Number((sign * this.#vel * this.speed.value / 100).toPrecision(6));
      move(velocity);
      held = setInterval(() => move(velocity), HELD);
      event.preventDefault();
      event.target.focus();
    };
    const end = () => {
      if (!held) return;
      clearInterval(held);
      held = 0;
      move(0);
    };
    return el("button", {
      type: "button", "aria-label": `${name} ${axis.name}`, title: `${name} ${axis.name}, as long as it is held`,
      onpointerdown: begin, onkeydown: begin, onpointerup: end, onpointercancel: end, onkeyup: end, onblur: end,
    }, text);
  }

  show(frame, every) {
    const { dest, position, load, enabled, hasFeedback, negative, positive, atNegative, atPositive, vel } = frame.axes[this.axis.axis];
    this.#enabled = enabled;
    this.#vel = vel;
    this.#used ||= enabled || dest !== 0 || position !== 0;
    this.element.hidden = !(this.#used || every);
    if (this.element.hidden) return;
    this.#follow(frame.tick, dest);
    const [atDest, at, error, velocity, limits] = this.cells;
    say(atDest, short(dest));
    say(at, short(hasFeedback ? position : load));
    mark(at, "load", !hasFeedback);
    attribute(at, "title", hasFeedback ? "Measured position" : "Open loop: position of the load");
    say(error, hasFeedback ? short(dest - position) : "–");
    say(velocity, short(this.#velocity));
    const reached = atNegative ? "− reached" : atPositive ? "+ reached" : "";
    const range = Number.isNaN(negative) ? "–" : negative > -1e29 || positive < 1e29 ? `${bound(negative)} … ${bound(positive)}` : "none";
    say(limits, reached || range);
    mark(limits, "reached", reached !== "");
    mark(this.element, "off", !enabled);
    const word = enabled ? "Disable" : "Enable";
    say(this.enable, word);
    attribute(this.enable, "aria-label", `${word} ${this.axis.name}`);
    attribute(this.enable, "title", `${word} ${this.axis.name}`);
    attribute(this.lamp, "aria-label", enabled ? "enabled" : "disabled");
    attribute(this.lamp, "title", enabled ? "enabled" : "disabled");
  }

  /** The velocity between frames at least 20 ms of board time apart, or of one tick where the board is stepped. */
  #follow(tick, dest) {
    const before = this.#before;
    if (!before || tick < before.tick) {
      this.#before = { tick, dest };
      return;
    }
    const ticks = tick - before.tick;
    if (ticks >= 200 || ticks === 1) {
      this.#velocity = (dest - before.dest) / (ticks * TICK);
      this.#before = { tick, dest };
    }
  }
}

function bound(value) {
  return Math.abs(value) > 1e29 ? "∞" : short(value);
}
