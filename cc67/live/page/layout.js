// The sizes of the panels: each can fill the page, and the borders between them can be moved.

import { attribute, el, head } from "./dom.js";

/** The smallest panel, in pixels. */
const LEAST = { columns: 160, rows: 70 };
const KEY = "cc67-layout";

export function mountLayout(panels) {
  const sections = [...panels.querySelectorAll("section")];
  for (const section of sections) if (section.id !== "timeline" && !section.querySelector(".head")) head(section);
  const grips = sections.filter(({ id }) => id !== "timeline").map((section) => new Grip(section, panels));
  let whole = null;

  function fill(section) {
    whole = whole === section ? null : section;
    panels.classList.toggle("whole", whole !== null);
    for (const { section: one, button } of buttons) {
      one.classList.toggle("is-whole", one === whole);
      attribute(button, "aria-pressed", one === whole);
    }
    dispatchEvent(new Event("resize"));
  }

  const buttons = grips.map(({ section, name }) => {
    const button = el("button", {
      type: "button", className: "fill", "aria-label": `Maximise ${name}`, title: "Fill the page; Escape shows all again",
      "aria-pressed": "false", onclick: () => fill(section),
    }, "⤢");
    section.querySelector(".head").append(button);
    return { section, button };
  });
  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && whole) fill(whole);
  });
  addEventListener("resize", () => arrange(panels));
  arrange(panels);
}

/** Sizes that somebody has chosen, for each arrangement of the panels; `{}` where there are none. */
function chosen() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {};
  }
}

/** The names of the panels by rows and columns, as the style has them; empty where one panel is shown at a time. */
function areas(panels) {
  const rows = getComputedStyle(panels).gridTemplateAreas.match(/"[^"]*"/g) ?? [];
  return getComputedStyle(panels).display === "grid" ? rows.map((row) => row.slice(1, -1).split(/\s+/)) : [];
}

/** Gives the panels the sizes that were chosen. */
function arrange(panels) {
  panels.style.gridTemplateColumns = panels.style.gridTemplateRows = "";
  const sizes = chosen()[JSON.stringify(areas(panels))];
  if (!sizes || panels.classList.contains("whole")) return;
  if (sizes.columns) panels.style.gridTemplateColumns = tracks(sizes.columns);
  // The last row is the timeline, which has the size that it needs.
  if (sizes.rows) panels.style.gridTemplateRows = `${tracks(sizes.rows)} auto`;
}

const tracks = (sizes) => sizes.map((size) => `minmax(0, ${size.toFixed(1)}fr)`).join(" ");

/** The corner of a panel: it moves the borders on its right and below. */
class Grip {
  constructor(section, panels) {
    this.section = section;
    this.panels = panels;
    this.name = section.querySelector("h2").textContent;
    this.element = el("button", {
      type: "button", className: "grip", "aria-label": `Resize ${this.name}`,
      title: "Drag, or press arrow keys, to resize; double click for the usual sizes",
      onpointerdown: (event) => this.#drag(event), onkeydown: (event) => this.#key(event), ondblclick: () => this.#reset(),
    });
    section.append(this.element);
  }

  /** Sizes now, and the index of the last track of this panel. */
  #present() {
    const names = areas(this.panels), style = getComputedStyle(this.panels);
    const sizes = (text) => text.split(" ").map(Number.parseFloat);
    const [columns, rows] = [sizes(style.gridTemplateColumns), sizes(style.gridTemplateRows).slice(0, -1)];
    const row = names.findLastIndex((row) => row.includes(this.section.id));
    return { key: JSON.stringify(names), columns, rows, row, column: names[row]?.lastIndexOf(this.section.id) ?? -1 };
  }

  #move({ key, columns, rows, row, column }, x, y) {
    const sizes = { columns: shifted(columns, column, x, LEAST.columns), rows: shifted(rows, row, y, LEAST.rows) };
    const all = chosen();
    localStorage.setItem(KEY, JSON.stringify({ ...all, [key]: { ...all[key], ...(x ? { columns: sizes.columns } : {}), ...(y ? { rows: sizes.rows } : {}) } }));
    dispatchEvent(new Event("resize"));
  }

  #drag(event) {
    const from = this.#present();
    if (from.column < 0) return;
    event.preventDefault();
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    const move = (moved) => this.#move(from, moved.clientX - event.clientX, moved.clientY - event.clientY);
    this.element.addEventListener("pointermove", move);
    const end = () => this.element.removeEventListener("pointermove", move);
    this.element.addEventListener("pointerup", end, { once: true });
    this.element.addEventListener("pointercancel", end, { once: true });
  }

  #key(event) {
    const step = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] }[event.key];
    if (!step) return;
    event.preventDefault();
    const from = this.#present();
    if (from.column >= 0) this.#move(from, ...step);
  }

  #reset() {
    const { [this.#present().key]: _, ...others } = chosen();
    localStorage.setItem(KEY, JSON.stringify(others));
    dispatchEvent(new Event("resize"));
  }
}

/** Sizes after the border behind one of them has moved; the next one gives or takes. */
function shifted(sizes, index, by, least) {
  const next = index + 1;
  if (next >= sizes.length) return sizes;
  const change = Math.max(Math.min(least - sizes[index], 0), Math.min(by, Math.max(sizes[next] - least, 0)));
  return sizes.map((size, at) => (at === index ? size + change : at === next ? size - change : size));
}
