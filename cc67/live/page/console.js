// The console: what programs print, what the board answers, remarks and traps; and a field for script commands.

import { el, head } from "./dom.js";

const KEPT = 2000;
const WORDS = [
  "Abort", "Accel", "ADC", "CheckDone", "ClearBit", "ConsolePrint", "DAC", "Dest", "DisableAxis", "Enabled", "EnableAxis",
  "EnableAxisDest", "Execute", "GetBit", "GetPersistDec", "GetPersistHex", "Jerk", "Jog", "Kill", "LimitSwitch", "Move",
  "MoveAtVel", "MoveRel", "Pos", "ReadBit", "SetBit", "SetPersistDec", "SetPersistHex", "SetStateBit", "Vel", "Version", "Zero",
];

export function mountConsole(section, link, openSource) {
  const only = el("input", { type: "checkbox", "aria-label": "Only program output" });
  head(section, el("span", { className: "grow" }), el("label", { className: "quiet" }, only, " programs only"),
    el("button", { type: "button", onclick: () => lines.replaceChildren() }, "Clear"));
  const lines = el("div", { className: "lines", role: "log", "aria-label": "Messages", tabIndex: 0 });
  const field = el("input", { type: "text", "aria-label": "Console", placeholder: "script command, such as Move0=500", spellcheck: false, autocomplete: "off" });
  field.setAttribute("list", "words");
  const form = el("form", { className: "prompt" }, field, el("button", { type: "submit" }, "Send"),
    el("datalist", { id: "words" }, ...WORDS.map((word) => el("option", { value: word }))));
  section.append(lines, form);
  only.addEventListener("change", () => lines.classList.toggle("only", only.checked));

  const history = [];
  let at = 0;
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const line = field.value.trim();
    if (!line) return;
    link.ask("command", { line });
    if (history.at(-1) !== line) history.push(line);
    at = history.length;
    field.value = "";
  });
  field.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!step || !history.length) return;
    event.preventDefault();
    at = Math.max(0, Math.min(history.length, at + step));
    field.value = history[at] ?? "";
  });

  function add(entries) {
    const isAtEnd = lines.scrollHeight - lines.scrollTop - lines.clientHeight < 40;
    lines.append(...entries.slice(-KEPT).map((entry) => line(entry, openSource)));
    while (lines.childElementCount > KEPT) lines.firstElementChild.remove();
    if (isAtEnd) lines.scrollTop = lines.scrollHeight;
  }

  let isFirst = false;
  link.on("state", (is) => { isFirst = is; });
  link.on("cut", ({ tick }) => {
    while (Number(lines.lastElementChild?.dataset.tick) > tick) lines.lastElementChild.remove();
  });
  link.on("log", ({ entries }) => {
    if (isFirst) lines.replaceChildren();
    isFirst = false;
    add(entries);
  });
}

function line({ tick, voice, text, file, line, accesses }, openSource) {
  const row = el("p", { className: voice }, el("time", {}, (tick * 90e-6).toFixed(3)), voice === "command" ? `> ${text}` : text);
  row.dataset.tick = tick;
  const places = accesses ?? (file && line ? [{ file, line }] : []);
  for (const place of places) row.append(" ", el("button", { type: "button", className: "link", onclick: () => openSource(place.file, place.line) }, `${place.file.split("/").pop()}:${place.line}`));
  return row;
}
