//! The program `report`: what it is asked, what it measures, what it concludes and what it writes.

mod asking;
mod budgeting;
mod growing;
mod keeping;
mod listing;
mod measuring;
mod scoring;
mod verdicts;
mod writing;
