//! A guide through the chapter, section by section.
#![doc = include_str!("../docs/guide.md")]
