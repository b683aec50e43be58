// The threads: what each does and waits for, at which line; start and stop.

import { el } from "./dom.js";

export function mountThreads(section, link, sources, openSource) {
  const body = el("div", { className: "body" });
  section.append(body);
  let programs = new Map(), rows = [];

  function show() {
    const used = rows.filter((row) => row.state !== "empty" || programs.has(row.thread));
    body.replaceChildren(...used.map(thread));
    if (!used.length) body.append(el("p", { className: "quiet" }, "No program is loaded."));
  }

  function thread({ thread, state, waits, stack }) {
    const place = stack[0];
    const isActive = state === "running" || state === "waiting";
    const act = (what) => el("button", { type: "button", "aria-label": `${what} thread ${thread}`, onclick: () => link.ask(what.toLowerCase(), { thread }) }, what);
    const row = el("div", { className: "thread" },
      el("strong", {}, String(thread)),
      el("span", {}, el("span", { className: "mono" }, programs.get(thread) ?? ""), " ", el("span", { className: `badge ${state}` }, label(state, waits))),
      el("span", {}, act("Start"), " ", isActive ? act("Stop") : ""));
    if (place?.line) {
      const text = sources.line(place.file, place.line).trim();
      row.append(el("span", { className: "where" },
        el("button", { type: "button", className: "link", onclick: () => openSource(place.file, place.line) }, `${place.file.split("/").pop()}:${place.line}`),
        ` in ${place.function} `, el("code", {}, text)));
    }
    return row;
  }

  link.on("hello", (hello) => {
    programs = new Map(hello.programs.map(({ thread, file }) => [thread, file.split("/").pop()]));
    show();
  });
  link.on("sources", show);
  link.on("threads", ({ threads }) => {
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
