// The bar: board time, its speed, run and pause, one tick, one slice, Reload; STOP, and who controls a controller.

import { attribute, el, say } from "./dom.js";
import { themeButton } from "./theme.js";

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 10, 100];

export function mountClock(bar, link) {
  const title = el("h1", {}, "cc67 live");
  const time = el("span", { className: "mono time", title: "Board time" }, "0.000 s");
  const speed = el("span", { className: "mono quiet speed" });
  const run = el("button", { type: "button", className: "main", onclick: toggle }, "Pause");
  const step = (name, what, about) =>
    el("button", { type: "button", title: about, onclick: () => link.ask(what) }, name);
  const choose = el(
    "select",
    { "aria-label": "Speed", onchange: () => link.ask("run", { speed: Number(choose.value) }) },
    ...SPEEDS.map((factor) => el("option", { value: String(factor) }, `${factor}×`)),
  );
  const reload = el("button", { type: "button", className: "far", title: "Compile, load and start the programs (Alt+R)", onclick: () => link.ask("reload") }, "Reload");
  const stop = el("button", { type: "button", className: "stop", title: "Stop all threads and disable all axes (Alt+X)", onclick: () => link.ask("halt") }, "STOP");
  const control = el("input", { type: "checkbox", role: "switch", onchange: () => link.ask("control", { on: control.checked }) });
  const controls = el("label", { className: "control", hidden: true, title: "Off: this page only looks at the controller. On: it can move the machine." }, control, " Control");
  let running = true, isReal = false;

  function toggle() {
    link.ask(running ? "pause" : "run");
  }

  const tick = step("Tick", "tick", "One servo tick of 90 µs"), slice = step("Slice", "slice", "To the end of the next slice");
  bar.append(
    stop, title, run, tick, slice, choose, time, speed, el("span", { className: "grow" }), controls, reload, themeButton(),
  );
  addEventListener("keydown", (event) => {
    if (!event.altKey || event.ctrlKey || event.metaKey) return;
    const act = { KeyR: () => reload.click(), KeyP: toggle, KeyT: () => link.ask("tick"), KeyS: () => link.ask("slice"), KeyX: () => stop.click() }[event.code];
    if (act) {
      event.preventDefault();
      act();
    }
  });

  link.on("hello", (hello) => {
    isReal = hello.time === "real";
    // A board whose time passes as its clients need it, or by itself, has no clock to be set.
    for (const part of [run, tick, slice, choose]) part.hidden = isReal || hello.time === "foreign";
    controls.hidden = !isReal;
    say(reload, isReal ? "Load" : "Reload");
    const names = hello.programs.map(({ file }) => file.split(/[\\/]/).pop()).join(", ");
    say(title, names || "cc67 live");
    title.title = hello.title;
    document.title = `${names || "board"} · cc67 live`;
  });
  link.on("access", (access) => {
    control.checked = access.control;
    control.disabled = Boolean(access.lost);
  });
  link.on("programs", ({ waiting }) => {
    reload.classList.toggle("main", waiting.length > 0);
  });
  link.on("frame", (frame) => {
    running = frame.running;
    say(run, running ? "Pause" : "Run");
    say(time, `${(frame.tick * 90e-6).toFixed(3)} s`);
    say(speed, isReal ? "" : frame.running ? `${frame.measured.toFixed(2)}×` : "stopped");
    const value = String(frame.asked);
    if (document.activeElement !== choose && choose.value !== value && SPEEDS.includes(frame.asked)) choose.value = value;
    attribute(run, "data-running", running);
  });
}
