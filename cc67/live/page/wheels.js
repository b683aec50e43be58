// Encoders as wheels: the mouse's wheel, a drag upwards, or the arrow keys turn them.

import { attribute, el, say } from "./dom.js";

/** Counts of a notch, and of a notch with Shift. */
const NOTCH = 4, FAST = 40;
/** Pixels of a drag that are a notch. */
const PIXELS = 6;
/** A turn takes so long at least, so that the board's decoder follows. */
const TIME = "20ms";

export function mountWheels(parent, link) {
  const box = el("div", { className: "wheels" });
  // The machine turns the encoders of a controller.
  link.on("hello", ({ time }) => { details.hidden = time === "real"; });
  const details = el("details", {}, el("summary", {}, "Encoders"),
    el("p", { className: "quiet" }, "Turn with the mouse's wheel, a drag, or the arrow keys; faster with Shift."), box);
  parent.append(details);
  for (let index = 0; index < 8; index += 1) box.append(wheel(index, link));
}

function wheel(index, link) {
  let turned = 0, waiting = 0, dragged = null;
  const value = el("span", { className: "mono" }, "0");
  const element = el("div", {
    className: "wheel", role: "spinbutton", tabIndex: 0, "aria-label": `encoder ${index}`, "aria-valuenow": "0",
  }, el("span", { className: "knob", "aria-hidden": "true" }), el("span", {}, `encoder ${index} `), value);

  /** Turns of one moment are one movement. */
  function turn(counts) {
    if (!counts) return;
    if (!waiting) setTimeout(send, 30);
    waiting += counts;
  }
  function send() {
    if (waiting) link.ask("act", { text: `encoder ${index} moves ${waiting} in ${TIME}` });
    turned += waiting;
    waiting = 0;
    say(value, String(turned));
    attribute(element, "aria-valuenow", turned);
    element.style.setProperty("--turn", `${(turned * 360) / 400}deg`);
  }

  const notch = (event) => (event.shiftKey ? FAST : NOTCH);
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    turn(-Math.sign(event.deltaY || event.deltaX) * notch(event));
  }, { passive: false });
  element.addEventListener("keydown", (event) => {
    const step = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    turn(step * notch(event));
  });
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture?.(event.pointerId);
    dragged = event.clientY;
  });
  element.addEventListener("pointermove", (event) => {
    if (dragged === null) return;
    const notches = Math.trunc((dragged - event.clientY) / PIXELS);
    dragged -= notches * PIXELS;
    turn(notches * notch(event));
  });
  for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => { dragged = null; });
  return element;
}
