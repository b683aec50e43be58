// On a narrow page one panel at a time, chosen by tabs.

import { attribute, el } from "./dom.js";

export function mountTabs(parent, panels) {
  const nav = el("div");
  parent.append(nav);
  const sections = [...panels.querySelectorAll("section")];
  nav.setAttribute("role", "tablist");
  const tabs = sections.map((section) => el("button", {
    type: "button", role: "tab", id: `tab-${section.id}`, "aria-controls": section.id, onclick: () => show(section.id),
  }, section.querySelector("h2").textContent));
  nav.append(...tabs);

  function show(id) {
    sections.forEach((section, index) => {
      section.classList.toggle("shown", section.id === id);
      attribute(tabs[index], "aria-selected", section.id === id);
      tabs[index].tabIndex = section.id === id ? 0 : -1;
      if (section.id === id) tabs[index].scrollIntoView({ block: "nearest", inline: "nearest" });
    });
    dispatchEvent(new Event("resize"));
  }

  nav.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    const at = (tabs.indexOf(document.activeElement) + step + tabs.length) % tabs.length;
    tabs[at].focus();
    show(sections[at].id);
  });
  addEventListener("showpanel", ({ detail }) => show(detail));
  show(sections[0].id);
}
