// The timeline: drag back to a moment of the run, look, and go on from there; take up a run that was left; save a test.

import { attribute, el, say } from "./dom.js";

export function mountTimeline(section, link) {
  const slider = el("input", { type: "range", min: "0", max: "1", value: "1", step: "1", "aria-label": "Timeline", title: "Drag to go back to any moment of the run" });
  const at = el("output", { className: "mono times" });
  const latest = el("button", { type: "button", disabled: true, onclick: () => link.ask("goto", { tick: end }) }, "Latest");
  const state = el("span", { className: "quiet", role: "status" });
  const restart = el("button", { type: "button", title: "Power the board off and on, and start again", onclick: () => link.ask("restart") }, "Restart");
  const machine = el("span", { role: "status" });
  const left = el("span", { className: "left", role: "group", "aria-label": "Runs that were left" });
  const name = el("input", { type: "text", "aria-label": "Test name", placeholder: "name of the test", pattern: "[A-Za-z0-9_\\-]+", required: true, size: 16 });
  const form = el("form", { className: "save" }, name, el("button", { type: "submit" }, "Save as test"));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    link.ask("save", { name: name.value });
  });
  section.append(el("div", { className: "row" },
    section.querySelector("h2"), slider, at, latest,
    restart, form),
    el("div", { className: "row runs" }, state, machine, left));
  let end = 0, wanted = null, asked = null, held = false;

  /** One question at a time: the next is where the slider is by then. */
  function ask() {
    if (wanted === null || asked !== null) return;
    asked = wanted;
    wanted = null;
    link.ask("goto", { tick: asked });
  }

  // An action belongs to the moment to which the slider was dragged.
  link.before(() => {
    if (wanted === null) return;
    asked = null;
    ask();
  });
  slider.addEventListener("pointerdown", () => { held = true; });
  addEventListener("pointerup", () => { held = false; });
  slider.addEventListener("input", () => {
    wanted = slider.valueAsNumber;
    ask();
  });
  link.on("frame", (frame) => {
    end = frame.end;
    if (asked !== null) {
      if (frame.tick === asked || !frame.past) asked = null;
      ask();
    }
    // Under the pointer nothing moves by itself.
    if (!held) attribute(slider, "max", frame.end);
    if (!held && wanted === null && asked === null && slider.valueAsNumber !== frame.tick) slider.value = String(frame.tick);
    attribute(slider, "aria-valuetext", `${(frame.tick * 90e-6).toFixed(3)} seconds`);
    say(at, `${(frame.tick * 90e-6).toFixed(3)} / ${(frame.end * 90e-6).toFixed(3)} s`);
    latest.disabled = !frame.past;
    say(state, frame.past ? "in the past: your next action continues from here; the later run is kept" : "Drag back to any moment of the run.");
    section.classList.toggle("past", frame.past);
  });
  // A board that others use does not go back.
  link.on("hello", ({ time }) => {
    for (const part of [section, document.getElementById("tab-timeline")]) part.hidden = time !== "full";
  });
  link.on("machine", ({ text, wrong }) => {
    say(machine, text ?? "");
    machine.className = wrong ? "bad" : "changed";
    restart.classList.toggle("main", Boolean(text) && !wrong);
  });
  link.on("branches", ({ branches }) => {
    left.replaceChildren(...branches.map(({ id, from, end }) => {
      const name = `${seconds(from)} … ${seconds(end)} s`;
      return el("span", { className: "branch" },
        el("button", { type: "button", title: `A run that was left at ${seconds(from)} s: show it again, to its end`, onclick: () => link.ask("branch", { id }) }, `Run ${name}`),
        el("button", { type: "button", title: "Drop this run", "aria-label": `Drop run ${name}`, onclick: () => link.ask("forget", { id }) }, "×"));
    }));
  });
  link.on("state", () => { asked = null; });
  link.on("problem", () => { asked = null; });
}

const seconds = (tick) => (tick * 90e-6).toFixed(3);
