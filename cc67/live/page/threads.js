// The threads: what each does and waits for, at which line, its stack, and the slices of the last ticks; start and stop.

import { attribute, el } from "./dom.js";
import { color } from "./plot.js";

/** Races that are shown. */
const RACES = 3;

export function mountThreads(section, link, sources, openSource) {
  const body = el("div", { className: "body" });
  const strip = el("div", { className: "turns", role: "img", "aria-label": "Slices of the last ticks", hidden: true });
  const races = el("div", { className: "races", role: "log", "aria-label": "Accesses of two threads", hidden: true });
  section.append(strip, races, body);
  let programs = new Map(), rows = [], known = "", raced = [];

  /**
   * A mark for each of the last ticks, in the colour of its thread; the primary thread has none. A line follows a slice that
   * ended inside a statement, and a tick of a race is framed.
   */
  function slices(turns, tick) {
    strip.hidden = turns.length === 0;
    while (strip.childElementCount < turns.length) strip.append(el("span"));
    while (strip.childElementCount > turns.length) strip.lastElementChild.remove();
    const raceTicks = new Set(raced.map((entry) => entry.tick - tick + turns.length - 1));
    turns.forEach(({ thread, split }, index) => {
      const mark = strip.children[index];
      mark.style.background = thread ? color(thread - 1) : "";
      mark.classList.toggle("split", Boolean(split));
      mark.classList.toggle("race", raceTicks.has(index));
    });
    const counts = new Map();
    for (const { thread } of turns) counts.set(thread, (counts.get(thread) ?? 0) + 1);
    const parts = [...counts].sort(([a], [b]) => a - b).map(([thread, count]) => `${thread ? `thread ${thread}` : "primary thread"}: ${count}`);
    const splits = turns.filter(({ split }) => split), last = splits.at(-1);
    const inside = last ? `. Switched inside a statement: ${splits.length}, last thread ${last.thread} at ${last.split}` : "";
    attribute(strip, "title", `The last ${turns.length} ticks. ${parts.join(", ")}${inside}`);
  }

  /** The last accesses of two threads that do not wait for each other, with links to both. */
  function showRaces() {
    races.hidden = raced.length === 0;
    races.replaceChildren(...raced.map(({ tick, text, accesses }) => el("p", { title: text },
      el("time", {}, (tick * 90e-6).toFixed(3)), " ", place(accesses[0]), " ⇄ ", place(accesses[1]))));
  }

  function place({ thread, file, line }) {
    const name = thread ? `thread ${thread}` : "call-back";
    return el("span", {},
      el("strong", thread ? { style: `color: ${color(thread - 1)}` } : {}, name), " ",
      el("button", { type: "button", className: "link", onclick: () => openSource(file, line) }, `${file.split("/").pop()}:${line}`));
  }

  function show() {
    const used = rows.filter((row) => row.state !== "empty" || programs.has(row.thread));
    body.replaceChildren(...used.map(thread));
    if (!used.length) body.append(el("p", { className: "quiet" }, "No program is loaded."));
  }

  /** A thread is one line; a trap has another one for its reason. */
  function thread({ thread, state, waits, stack, stack_used: used, stack_size: size }) {
    const place = stack[0];
    const isActive = state === "running" || state === "waiting", isTrapped = state === "trapped";
    const act = (what) => el("button", { type: "button", "aria-label": `${what} thread ${thread}`, onclick: () => link.ask(what.toLowerCase(), { thread }) }, what);
    const where = el("span", { className: "where" });
    if (place?.line) {
      const text = sources.line(place.file, place.line).trim();
      const name = place.file.split("/").pop();
      where.title = `${name}:${place.line} in ${place.function}: ${text}`;
      where.append(
        el("button", { type: "button", className: "link", onclick: () => openSource(place.file, place.line) }, `${name}:${place.line}`),
        ` ${place.function} `, el("code", {}, text));
    }
    const stackUse = el("span", { className: used > size ? "stack bad" : "stack quiet" });
    if (used) {
      stackUse.title = `worst stack ${used} of ${size} bytes: the peak so far, and the stack of a real board`;
      stackUse.textContent = `${used} B`;
    }
    const word = isTrapped ? "trap" : label(state, waits);
    const row = el("div", { className: isTrapped ? "thread trap" : "thread" },
      el("strong", { style: `color: ${color(thread - 1)}` }, String(thread)),
      el("span", { className: "mono file", title: programs.get(thread) ?? "" }, programs.get(thread) ?? ""),
      el("span", { className: `badge ${state}`, title: word }, word),
      where, stackUse,
      el("span", { className: "acts" }, act("Start"), isActive ? act("Stop") : ""));
    if (isTrapped) row.append(el("p", { className: "reason", role: "alert" }, waits));
    return row;
  }

  link.on("hello", (hello) => {
    programs = new Map(hello.programs.map(({ thread, file }) => [thread, file.split("/").pop()]));
    show();
  });
  link.on("sources", show);
  addEventListener("themechange", show);
  link.on("state", () => {
    raced = [];
    showRaces();
  });
  link.on("cut", ({ tick }) => {
    raced = raced.filter((entry) => entry.tick <= tick);
    showRaces();
  });
  link.on("log", ({ entries }) => {
    const found = entries.filter((entry) => entry.accesses);
    if (!found.length) return;
    raced = [...raced, ...found].slice(-RACES);
    showRaces();
  });
  link.on("threads", ({ threads, turns, tick }) => {
    // Without a word about them, those of a moment ago stay.
    if (turns) slices(turns, tick);
    // What has not changed is left alone, so that a button keeps the focus.
    const text = JSON.stringify(threads);
    if (text === known) return;
    known = text;
    rows = threads;
    show();
  });
}

function label(state, waits) {
  if (state === "waiting") return /^\d/.test(waits) ? `waits until ${waits}` : `waits for ${waits}`;
  if (state === "trapped") return `trap: ${waits}`;
  if (state === "ready") return "not running";
  return waits ? `${state}: ${waits}` : state;
}
