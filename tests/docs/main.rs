//! Tests of the texts that people read: the book and the programs do what they say.

mod book;
mod commands;
mod messages;
mod mistakes;
mod phrases;
mod programs;
