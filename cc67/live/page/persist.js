// `persist.UserData`: each word as an integer, a float, a double of two words, and in hexadecimal; integers can be set.

import { el, say, short } from "./dom.js";

const WORDS = 200;

export function mountPersist(parent, link) {
  let isReal = false;
  link.on("hello", ({ time }) => { isReal = time === "real"; });
  // What is done to a simulated board is a statement, so that a test can do it again.
  const store = (index, value) => isReal
    ? link.ask("write", { expression: `persist.UserData[${index}]`, value })
    : link.ask("act", { text: `persist ${index} = ${value}` });
  const all = el("input", { type: "checkbox" });
  const body = el("tbody");
  const names = ["persist", "int", "float", "double", "hex"];
  const table = el("table", { className: "persist", "aria-label": "persist.UserData" },
    el("thead", {}, el("tr", {}, ...names.map((name) => el("th", { scope: "col" }, name)))), body);
  const none = el("p", { className: "quiet" }, "All are 0.");
  const details = el("details", {}, el("summary", {}, "Persist"), el("label", {}, all, " also those that are 0"), none, table);
  parent.append(details);
  const rows = Array.from({ length: WORDS }, (_, index) => new Word(index, store));
  body.append(...rows.map((row) => row.element));

  link.on("frame", ({ persist }) => {
    if (!details.open) return;
    let shown = 0;
    for (const row of rows) shown += row.show(persist, all.checked) ? 1 : 0;
    none.hidden = shown > 0;
    table.hidden = shown === 0;
  });
}

class Word {
  constructor(index, store) {
    this.index = index;
    this.input = el("input", { type: "number", step: "1", min: "-2147483648", max: "2147483647", "aria-label": `persist ${index}` });
    this.input.addEventListener("change", () => {
      const value = this.input.valueAsNumber;
      if (Number.isInteger(value)) store(index, value);
    });
    this.cells = Array.from({ length: 3 }, () => el("td", { className: "mono" }));
    this.element = el("tr", {}, el("th", { scope: "row" }, String(index)), el("td", {}, this.input), ...this.cells);
  }

  /** Whether it is shown. */
  show(persist, isAll) {
    const at = 4 * this.index;
    const value = persist.getInt32(at, true);
    const isShown = isAll || value !== 0;
    if (this.element.hidden === isShown) this.element.hidden = !isShown;
    if (!isShown) return false;
    if (document.activeElement !== this.input && this.input.value !== String(value)) this.input.value = String(value);
    const [float, double, hex] = this.cells;
    say(float, number(persist.getFloat32(at, true)));
    say(double, this.index % 2 ? "" : number(persist.getFloat64(at, true)));
    say(hex, `0x${(value >>> 0).toString(16).padStart(8, "0")}`);
    return true;
  }
}

/** Words that are no float of any use look like tiny or huge ones. */
function number(value) {
  const size = Math.abs(value);
  if (value !== 0 && (size < 1e-6 || size >= 1e15 || !Number.isFinite(value))) return "–";
  return short(value);
}
