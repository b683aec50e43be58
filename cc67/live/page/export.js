// What the scope shows, as files.

const TICK_NS = 90_000;

export function asCsv(history, first, last) {
  const quoted = (name) => (/[",]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);
  const lines = [["time", ...history.names.map(quoted)].join(",")];
  for (let row = first; row <= last; row++) {
    const values = history.names.map((_, signal) => history.value(row, signal));
    lines.push([Number((history.tick(row) * 90e-6).toFixed(6)), ...values].join(","));
  }
  return `${lines.join("\n")}\n`;
}

export function asVcd(history, first, last) {
  const id = (signal) => String.fromCharCode(33 + signal % 90) + (signal >= 90 ? String.fromCharCode(33 + Math.floor(signal / 90)) : "");
  const lines = ["$timescale 1 ns $end", "$scope module board $end"];
  history.names.forEach((name, signal) => lines.push(`$var real 64 ${id(signal)} ${name.replaceAll(/\s+/g, "")} $end`));
  lines.push("$upscope $end", "$enddefinitions $end");
  const before = [];
  for (let row = first; row <= last; row++) {
    const changed = history.names.map((_, signal) => signal).filter((signal) => history.value(row, signal) !== before[signal]);
    if (!changed.length && row !== last) continue;
    lines.push(`#${history.tick(row) * TICK_NS}`);
    for (const signal of changed) {
      before[signal] = history.value(row, signal);
      lines.push(`r${before[signal]} ${id(signal)}`);
    }
  }
  return `${lines.join("\n")}\n`;
}

/** Hands a file to the person. */
export function save(name, type, content) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement("a");
  Object.assign(link, { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
