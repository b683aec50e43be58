//! Tests of the texts for users: the book and the programs do what they describe.

mod book;
mod commands;
mod messages;
mod mistakes;
mod phrases;
mod programs;
