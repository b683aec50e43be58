// Light and dark: as the system says, until somebody chooses.

import { el } from "./dom.js";

const system = matchMedia("(prefers-color-scheme: dark)");

function chosen() {
  return localStorage.getItem("cc67-theme");
}

function apply() {
  document.documentElement.dataset.theme = chosen() ?? (system.matches ? "dark" : "light");
  dispatchEvent(new Event("themechange"));
}

/** The switch, and the theme from now on. */
export function themeButton() {
  const flip = () => {
    const dark = document.documentElement.dataset.theme === "dark";
    localStorage.setItem("cc67-theme", dark ? "light" : "dark");
    apply();
  };
  system.addEventListener("change", apply);
  apply();
  return el("button", { type: "button", className: "far", title: "Light or dark", "aria-label": "Theme", onclick: flip }, "◐");
}
