// The sources: the line of each thread, remarks and traps at their lines, what the compiler says of a saved file.

import { el, head } from "./dom.js";

/** Remarks and traps that are shown, the last ones. */
const REMARKS = 200;

/** The files as the board has sent them. */
export class Sources {
  files = new Map();

  /** The name that a file has here: messages may name it by its end alone. */
  find(name) {
    if (this.files.has(name)) return name;
    const plain = normal(name);
    return [...this.files.keys()].find((known) => normal(known) === plain || normal(known).endsWith(`/${plain}`));
  }

  /** The text of a line; empty if it is not known. */
  line(name, number) {
    return this.files.get(this.find(name))?.[number - 1] ?? "";
  }
}

function normal(path) {
  const parts = [];
  for (const part of path.replaceAll("\\", "/").split("/")) {
    if (part === ".." && parts.length && parts.at(-1) !== "..") parts.pop();
    else if (part !== "." && part !== "") parts.push(part);
  }
  return parts.join("/");
}

export function mountSource(section, link, sources) {
  const choose = el("select", { "aria-label": "File", onchange: () => show(choose.value) });
  const follow = el("input", { type: "checkbox", checked: true });
  const state = el("span", { className: "quiet", role: "status" });
  head(section, choose, el("label", { className: "quiet" }, follow, " follow"), el("span", { className: "grow" }), state);
  const code = el("div", { className: "source" });
  const body = el("div", { className: "body", role: "region", tabIndex: 0, "aria-label": "Text of the file" }, code);
  body.style.padding = "0";
  section.append(body);
  let isReal = false;
  const quiet = () => (isReal ? "a controller does not tell which line it executes" : "");
  link.on("hello", ({ time }) => {
    isReal = time === "real";
    if (!state.textContent) state.textContent = quiet();
  });
  let file = "", rows = [], threads = [], errors = [], known = "", remarks = new Map();

  function show(name) {
    if (!sources.files.has(name)) return;
    file = name;
    choose.value = name;
    rows = colour(sources.files.get(name).join("\n")).map((text, index) => {
      const who = el("span", { className: "who" });
      return { who, element: el("div", { className: "row" }, el("span", { className: "number" }, String(index + 1)), who, text) };
    });
    code.replaceChildren(...rows.map((row) => row.element));
    known = "";
    annotate();
    places();
  }

  /** Messages at their lines. */
  function annotate() {
    for (const old of code.querySelectorAll(".message")) old.remove();
    for (const row of rows) row.element.classList.remove("wrong");
    const mine = (where) => where.file && sources.find(where.file) === file;
    for (const error of errors.filter(mine)) at(error.line, error.report, "message report");
    for (const remark of remarks.values()) {
      if (mine(remark)) at(remark.line, remark.text, "message remark", remark.accesses?.[1]);
      const [first, second] = remark.accesses ?? [];
      if (second && mine(second)) at(second.line, remark.text, "message remark", first);
    }
  }

  /** A message at a line, with a link to the other access that it is about. */
  function at(number, text, className, other) {
    const row = rows[number - 1];
    if (!row) return;
    if (!className.endsWith("remark")) row.element.classList.add("wrong");
    const message = el("div", { className }, text);
    if (other) message.append(" ", el("button", { type: "button", className: "link", onclick: () => open(other.file, other.line) }, `${other.file.split("/").pop()}:${other.line}`));
    row.element.append(message);
  }

  /** The threads at their lines. */
  function places() {
    const here = new Map();
    for (const { thread, stack } of threads) {
      const place = stack.find((call) => call.line && sources.find(call.file) === file);
      if (place) here.set(place.line, [...(here.get(place.line) ?? []), thread]);
    }
    const now = JSON.stringify([...here]);
    // Threads are heard of ten times a second, and mostly stay where they are.
    const isNew = now !== known;
    known = now;
    if (isNew) rows.forEach((row, index) => {
      const mine = here.get(index + 1);
      row.element.classList.toggle("here", Boolean(mine));
      row.who.replaceChildren(...(mine ?? []).map((thread) => el("span", { title: `thread ${thread}`, role: "img", "aria-label": `thread ${thread}`, "data-thread": thread })));
    });
    if (follow.checked && here.size) reveal(Math.min(...here.keys()));
  }

  function reveal(number) {
    const row = rows[number - 1]?.element;
    if (!row) return;
    const [top, height] = [row.offsetTop - body.offsetTop, body.clientHeight];
    if (top < body.scrollTop + 20 || top > body.scrollTop + height - 40) body.scrollTop = top - height / 3;
  }

  function open(name, number) {
    const known = sources.find(name);
    if (!known) return;
    follow.checked = false;
    show(known);
    reveal(number);
    dispatchEvent(new CustomEvent("showpanel", { detail: "source" }));
  }

  link.on("sources", (message) => {
    sources.files = new Map(message.sources.map(({ file, text }) => [file, text.split(/\r?\n/)]));
    const names = [...sources.files.keys()], last = (name) => normal(name).split("/").pop();
    const isOne = (name) => names.filter((other) => last(other) === last(name)).length === 1;
    choose.replaceChildren(...names.map((name) => el("option", { value: name, title: name }, isOne(name) ? last(name) : name)));
    show(sources.files.has(file) ? file : [...sources.files.keys()][0]);
  });
  link.on("threads", (message) => {
    threads = message.threads;
    places();
  });
  link.on("log", ({ entries }) => {
    const placed = entries.filter((entry) => entry.file && entry.line);
    for (const entry of placed) remarks.set(`${entry.file}:${entry.line}:${entry.text}`, entry);
    while (remarks.size > REMARKS) remarks.delete(remarks.keys().next().value);
    if (placed.length) annotate();
  });
  link.on("programs", (message) => {
    errors = message.errors;
    const [error] = errors;
    const place = (error) => (error.file ? `${error.file}:${error.line}:${error.column}: ` : "");
    state.classList.toggle("bad", Boolean(error));
    state.textContent = error ? `${place(error)}${error.text}${errors.length > 1 ? ` (and ${errors.length - 1} more)` : ""}` : message.waiting.length ? `compiled; ${isReal ? "Load" : "Reload"} loads it` : quiet();
    annotate();
    if (error?.file && error.line) open(error.file, error.line);
  });
  return open;
}

const TOKENS = /(\/\*[\s\S]*?\*\/|\/\/[^\n]*)|("(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')|\b(if|else|for|while|do|return|break|continue|switch|case|default|int|char|double|float|void|unsigned|long|short|struct|static|const|volatile|extern|typedef|enum|union|sizeof|goto)\b|(#\s*\w+)|\b(0x[\da-fA-F]+|\d+\.?\d*(?:e[+-]?\d+)?f?)\b/g;
const KINDS = ["comment", "string", "word", "word", "number"];

/** The lines of a C text as coloured fragments. */
function colour(text) {
  const lines = [document.createDocumentFragment()];
  const put = (part, kind) => {
    part.split("\n").forEach((piece, index) => {
      if (index) lines.push(document.createDocumentFragment());
      if (piece) lines.at(-1).append(kind ? el("span", { className: `tok-${kind}` }, piece) : piece);
    });
  };
  let end = 0;
  for (const match of text.matchAll(TOKENS)) {
    put(text.slice(end, match.index));
    put(match[0], KINDS[match.slice(1).findIndex((group) => group !== undefined)]);
    end = match.index + match[0].length;
  }
  put(text.slice(end));
  return lines.map((line) => {
    const span = el("span");
    span.append(line);
    return span;
  });
}
