//! Keys whose value is a table, or else a number or a word.

use super::file::{
    DragLaw, DragOf, DragTable, EffectsShare, EffectsTable, EffectsWord, FallingTable, RestitutionOf, RestitutionTable,
};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use std::fmt;

impl<'de> Deserialize<'de> for DragTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Drag;
        impl<'de> Visitor<'de> for Drag {
            type Value = DragTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table, { linear = k } or { coefficient = C, density = rho }, or \"ball\" or \"sphere\"")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<DragTable, A::Error> {
                DragLaw::deserialize(MapAccessDeserializer::new(map)).map(DragTable::Law)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<DragTable, E> {
                DragOf::deserialize(StrDeserializer::new(word)).map(DragTable::Of)
            }
        }
        deserializer.deserialize_any(Drag)
    }
}

impl<'de> Deserialize<'de> for EffectsTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Effects;
        impl<'de> Visitor<'de> for Effects {
            type Value = EffectsTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"auto\", or a table such as { auto = 0.001 }")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<EffectsTable, A::Error> {
                EffectsShare::deserialize(MapAccessDeserializer::new(map)).map(EffectsTable::Share)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<EffectsTable, E> {
                EffectsWord::deserialize(StrDeserializer::new(word)).map(EffectsTable::Word)
            }
        }
        deserializer.deserialize_any(Effects)
    }
}

impl<'de> Deserialize<'de> for RestitutionTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Restitution;
        impl<'de> Visitor<'de> for Restitution {
            type Value = RestitutionTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a number from 0 to 1, a table such as { coefficient = 0.9, falls_above = 1.0 }, or \"ball\"",
                )
            }

            fn visit_f64<E: Error>(self, c_r: f64) -> Result<RestitutionTable, E> {
                Ok(RestitutionTable::Constant(c_r))
            }

            fn visit_i64<E: Error>(self, c_r: i64) -> Result<RestitutionTable, E> {
                Ok(RestitutionTable::Constant(c_r as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RestitutionTable, A::Error> {
                FallingTable::deserialize(MapAccessDeserializer::new(map)).map(RestitutionTable::Falling)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<RestitutionTable, E> {
                RestitutionOf::deserialize(StrDeserializer::new(word)).map(RestitutionTable::Of)
            }
        }
        deserializer.deserialize_any(Restitution)
    }
}
