// Message and input boxes that programs open on the PC: the program waits until one of the buttons is pressed.

import { el } from "./dom.js";

export function mountAsks(parent, link) {
  const answer = (setting) => link.ask("answer", { setting });

  function message({ text, buttons }) {
    return [el("p", { role: "alert" }, text), el("div", { className: "row" }, ...buttons.map((button, index) =>
      el("button", { type: "button", className: index ? "" : "main", onclick: () => answer(`msgbox=${button}`) }, label(button))))];
  }

  function input({ text }) {
    const field = el("input", { type: "number", step: "any", required: true, value: "0", "aria-label": text || "Number" });
    const form = el("form", { className: "row" }, field, el("button", { type: "submit", className: "main" }, "OK"),
      el("button", { type: "button", onclick: () => answer("input=cancel") }, "Cancel"));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (Number.isFinite(field.valueAsNumber)) answer(`input=${field.valueAsNumber}`);
    });
    return [el("p", { role: "alert" }, text), form];
  }

  link.on("asks", ({ box }) => {
    parent.hidden = !box;
    parent.replaceChildren(...(box ? (box.buttons ? message(box) : input(box)) : []));
  });
}

const label = (button) => (button === "ok" ? "OK" : button[0].toUpperCase() + button.slice(1));
