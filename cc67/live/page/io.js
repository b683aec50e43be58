// Inputs as switches, outputs as lamps, analog inputs as sliders.

import { attribute, el, head, mark, say } from "./dom.js";
import { mountGather } from "./gather.js";
import { mountPersist } from "./persist.js";
import { mountWheels } from "./wheels.js";

/** A press that is longer than this is a hold: the input goes back when it ends. */
const HOLD = 400;
const INPUTS = "Inputs: click switches, hold presses";

export function mountIo(section, link) {
  const add = el("input", { type: "number", min: "0", max: "2047", "aria-label": "Show bit", placeholder: "show bit", style: "width:7em" });
  head(section, el("span", { className: "grow" }), add);
  const inputs = el("div", { className: "bits" }), outputs = el("div", { className: "bits" });
  const sliders = el("div", { className: "sliders" });
  const analog = el("details", {}, el("summary", {}, "Analog"), sliders);
  const inputsHead = el("h3", {}, INPUTS);
  const body = el("div", { className: "body" },
    inputsHead, inputs, el("h3", {}, "Outputs"), outputs, analog);
  section.append(body);
  mountWheels(body, link);
  mountPersist(body, link);
  mountGather(body, link);
  let bits = [], known = "", wanted = [];
  const channels = Array.from({ length: 8 }, (_, index) => new Channel(index, link, sliders));

  function build(described) {
    const all = [...described, ...wanted.filter((bit) => !described.some((one) => one.bit === bit)).map((bit) => ({ bit, name: `bit ${bit}`, input: true, about: "" }))];
    bits = all.map((bit) => (bit.input ? new Input(bit, link) : new Lamp(bit)));
    inputs.replaceChildren(...bits.filter((bit) => bit instanceof Input).map((bit) => bit.element));
    outputs.replaceChildren(...bits.filter((bit) => bit instanceof Lamp).map((bit) => bit.element));
    if (!inputs.childElementCount) inputs.append(el("span", { className: "quiet" }, "programs read none; enter a number above to show one"));
  }

  let described = [];
  link.on("hello", (hello) => {
    // The machine drives the inputs of a controller.
    const isReal = hello.time === "real";
    inputs.inert = sliders.inert = isReal;
    say(inputsHead, isReal ? "Inputs" : INPUTS);
    if (JSON.stringify(hello.bits) === known) return;
    known = JSON.stringify(hello.bits);
    described = hello.bits;
    build(described);
  });
  add.addEventListener("change", () => {
    const bit = add.valueAsNumber;
    if (Number.isInteger(bit) && bit >= 0 && bit <= 2047 && !wanted.includes(bit)) wanted.push(bit);
    add.value = "";
    build(described);
  });
  link.on("frame", (frame) => {
    for (const bit of bits) bit.show(frame);
    for (const channel of channels) channel.show(frame);
  });
}

class Input {
  #level = 0;

  constructor({ bit, name, about }, link) {
    this.bit = bit;
    this.element = el("button", { type: "button", className: "bit", role: "switch", "aria-checked": "false", "aria-label": name, title: `bit ${bit}${about ? `, ${about}` : ""}` },
      el("span", { className: "dot" }), name);
    this.element.append(el("small", {}, name.startsWith("bit ") ? about ?? "" : String(bit)));
    const drive = (level) => {
      this.#level = level;
      link.ask("act", { text: `bit ${bit} = ${level}` });
    };
    let pressed = 0, wasPointer = false;
    this.element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.element.setPointerCapture?.(event.pointerId);
      [pressed, wasPointer] = [performance.now(), true];
      drive(1 - this.#level);
    });
    const release = () => {
      if (pressed && performance.now() - pressed > HOLD) drive(1 - this.#level);
      pressed = 0;
    };
    this.element.addEventListener("pointerup", release);
    this.element.addEventListener("pointercancel", release);
    this.element.addEventListener("click", () => {
      if (!wasPointer) drive(1 - this.#level);
      wasPointer = false;
    });
  }

  show(frame) {
    const level = frame.bit(this.bit);
    this.#level = level;
    mark(this.element, "on", level === 1);
    attribute(this.element, "aria-checked", level === 1);
  }
}

class Lamp {
  constructor({ bit, name, about }) {
    this.bit = bit;
    this.name = name;
    this.state = el("span", { className: "dot" });
    this.element = el("span", { className: "bit lamp", role: "img", "aria-label": `${name} is off`, title: `bit ${bit}${about ? `, ${about}` : ""}` }, this.state, name);
    if (!name.startsWith("bit ")) this.element.append(el("small", {}, String(bit)));
  }

  show(frame) {
    const level = frame.bit(this.bit) === 1;
    mark(this.element, "on", level);
    attribute(this.element, "aria-label", `${this.name} is ${level ? "on" : "off"}`);
  }
}

class Channel {
  constructor(index, link, parent) {
    this.index = index;
    this.input = el("input", { type: "range", min: "-2048", max: "2047", "aria-label": `adc ${index}`, oninput: () => link.ask("act", { text: `adc ${index} = ${this.input.value}` }) });
    this.value = el("output", { className: "mono" });
    parent.append(el("span", {}, `adc ${index}`), this.input, this.value);
  }

  show(frame) {
    const value = frame.adc(this.index);
    say(this.value, String(value));
    if (document.activeElement !== this.input && this.input.valueAsNumber !== value) this.input.value = String(value);
  }
}
