//! Arguments of a subcommand that are defined only when that subcommand is used.
//!
//! Twenty subcommands have some three hundred options; each start of the command needs the options of only one.

use clap::builder::Resettable;
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches};

use crate::cli::args::heading;

/// The arguments `T` of a subcommand.
#[derive(Debug)]
pub(super) struct Deferred<T>(pub(super) Box<T>);

impl<T> std::ops::Deref for Deferred<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> std::ops::DerefMut for Deferred<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T: FromArgMatches> FromArgMatches for Deferred<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        T::from_arg_matches(matches).map(|arguments| Self(Box::new(arguments)))
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, Error> {
        T::from_arg_matches_mut(matches).map(|arguments| Self(Box::new(arguments)))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.update_from_arg_matches(matches)
    }
}

impl<T: Args> Args for Deferred<T> {
    fn augment_args(command: Command) -> Command {
        command.defer(described::<T>)
    }

    fn augment_args_for_update(command: Command) -> Command {
        command.defer(described::<T>)
    }
}

/// Returns the subcommand with its arguments under their headings; its description comes from its row, not from their
/// type.
fn described<T: Args>(command: Command) -> Command {
    let (about, long) = (command.get_about().cloned(), command.get_long_about().cloned());
    let own = T::augment_args(Command::default());
    let command = if own.has_subcommands() { T::augment_args(command) } else { in_order(command, &own) };
    command.about(Resettable::from(about)).long_about(Resettable::from(long))
}

/// Returns `command` with the arguments of `own` in the order of their headings: help lists headings in the order of
/// first occurrence, which depends on the order of shared structures.
fn in_order(command: Command, own: &Command) -> Command {
    let place = |argument: &&Arg| {
        argument.get_help_heading().and_then(|at| heading::ORDER.iter().position(|known| *known == at))
    };
    let mut arguments: Vec<&Arg> = own.get_arguments().collect();
    // Arguments without a heading come first, as `None` is less than any position.
    arguments.sort_by_key(place);
    command
        .args(arguments.into_iter().cloned())
        .groups(own.get_groups().cloned())
        .after_help(Resettable::from(own.get_after_help().cloned()))
}
