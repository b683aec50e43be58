// The page: every panel in its place, then the link to the board.

import { mountAsks } from "./asks.js";
import { mountAxes } from "./axes.js";
import { mountClock } from "./clock.js";
import { mountConsole } from "./console.js";
import { mountIo } from "./io.js";
import { mountLayout } from "./layout.js";
import { Link } from "./link.js";
import { mountPath } from "./path.js";
import { mountScope } from "./scope.js";
import { mountSource, Sources } from "./source.js";
import { mountTabs } from "./tabs.js";
import { mountThreads } from "./threads.js";
import { mountTimeline } from "./timeline.js";

const at = (id) => document.getElementById(id);
const link = new Link(new URLSearchParams(location.search).get("token") ?? "");
const sources = new Sources();

mountTabs(at("tabs"), at("panels"));
mountClock(at("bar"), link);
mountAsks(at("asks"), link);
mountAxes(at("axes"), link);
mountScope(at("scope"), link);
mountPath(at("path"), link);
mountIo(at("io"), link);
const open = mountSource(at("source"), link, sources);
mountThreads(at("threads"), link, sources, open);
mountConsole(at("console"), link, open);
mountTimeline(at("timeline"), link);
mountLayout(at("panels"));

const notice = at("notice");
let hides = 0, access = null;
function tell(text, seconds) {
  if (access?.lost && seconds) return;
  clearTimeout(hides);
  notice.textContent = text;
  notice.hidden = !text;
  if (seconds) hides = setTimeout(() => tell(""), seconds * 1000);
}
link.on("refused", () => tell("Another cc67 answers at this address and does not know this page: open the address that it printed when it started."));
link.on("state", (isThere) => {
  tell(isThere ? "" : "Disconnected from the board. Reconnecting …");
  for (const part of [at("bar"), at("panels"), at("asks")]) part.inert = !isThere;
});

// A page that only looks at a controller, or has lost it, acts on nothing.
const ACTS = ".keys, .acts, .prompt, .persist, #asks";
function lock() {
  if (!access) return;
  const isLocked = !access.control || Boolean(access.lost);
  for (const part of document.querySelectorAll(ACTS)) part.inert = isLocked;
}
link.on("access", (message) => {
  access = message;
  lock();
  document.body.classList.toggle("lost", Boolean(access.lost));
  if (access.lost) tell(`The controller cannot be reached, and what this page shows is old: ${access.lost}`);
});
link.on("threads", lock);
link.on("machine", ({ text }) => { if (text) tell(text, 12); });
link.on("saved", ({ text }) => tell(text, 12));
link.on("problem", ({ text }) => tell(text, 8));

link.connect();
