//! Pages on topics: one file each, described by its first paragraph.

use super::{ExplainedName, first_sentence};

/// Names and pages.
const PAGES: &[(&str, &str)] = &[
    ("threads", include_str!("../pages/topics/threads.md")),
    ("races", include_str!("../pages/topics/races.md")),
    ("time", include_str!("../pages/topics/time.md")),
    ("motion", include_str!("../pages/topics/motion.md")),
    ("paths", include_str!("../pages/topics/paths.md")),
    ("homing", include_str!("../pages/topics/homing.md")),
    ("probing", include_str!("../pages/topics/probing.md")),
    ("spindle", include_str!("../pages/topics/spindle.md")),
    ("estop", include_str!("../pages/topics/estop.md")),
    ("tuning", include_str!("../pages/topics/tuning.md")),
    ("filter", include_str!("../pages/topics/filter.md")),
    ("gather", include_str!("../pages/topics/gather.md")),
    ("persist", include_str!("../pages/topics/persist.md")),
    ("flash", include_str!("../pages/topics/flash.md")),
    ("analog", include_str!("../pages/topics/analog.md")),
    ("kanalog", include_str!("../pages/topics/kanalog.md")),
    ("uart", include_str!("../pages/topics/uart.md")),
    ("pc", include_str!("../pages/topics/pc.md")),
    ("call-back", include_str!("../pages/topics/call-back.md")),
    ("kogna", include_str!("../pages/topics/kogna.md")),
    ("exit", include_str!("../pages/topics/exit.md")),
    ("machine", include_str!("../pages/machine.md")),
    ("stimulus", include_str!("../pages/stimulus.md")),
];

/// The page of a topic.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    PAGES.iter().find(|(name, _)| is_meant(name)).map(|(_, page)| (*page).to_owned())
}

/// Each topic with its heading.
pub(super) fn entries() -> Vec<ExplainedName> {
    let about = |page: &str| first_sentence(page.lines().next().unwrap_or_default().trim_start_matches("# "));
    PAGES.iter().map(|(name, page)| ExplainedName { name, about: about(page) }).collect()
}
