// Elements without ceremony.

/** Makes an element; properties that begin with `on` are listeners, `aria…` and `data…` and the like are attributes. */
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "style") element.style.cssText = value;
    else if (name in element && !name.startsWith("aria")) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/** Sets a text only where it differs: frames come often, changes do not. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** The same for a class. */
export function mark(element, name, is) {
  if (element.classList.contains(name) !== is) element.classList.toggle(name, is);
}

/** The same for an attribute. */
export function attribute(element, name, value) {
  if (element.getAttribute(name) !== String(value)) element.setAttribute(name, String(value));
}

/** A number with as many digits as fit a column. */
export function short(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size >= 1e9) return value.toExponential(2);
  if (Number.isInteger(value)) return String(value);
  return value.toFixed(size >= 10000 ? 1 : size >= 100 ? 2 : 3);
}

/** A head of a panel: its heading, and what stands beside it. */
export function head(section, ...controls) {
  const heading = section.querySelector("h2");
  const row = el("div", { className: "head" });
  heading.replaceWith(row);
  row.append(heading, ...controls);
  return row;
}
