//! The program `report`: its command line, its measurements, its conclusions and its files.

mod asking;
mod budgeting;
mod growing;
mod keeping;
mod listing;
mod measuring;
mod scoring;
mod verdicts;
mod writing;
