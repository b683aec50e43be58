//! Typed indexes into arenas.

/// Number types for indexes, each printed with a prefix: `v3`, `block0`.
macro_rules! index {
    ($($(#[$doc:meta])* $name:ident, $prefix:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);
        cranelift_entity::entity_impl!($name, $prefix);
    )*};
}
pub(crate) use index;
