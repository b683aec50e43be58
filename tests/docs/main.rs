//! What people read: the book and the programs do what they say.

mod book;
mod commands;
mod programs;
