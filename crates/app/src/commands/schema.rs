//! `carom schema`: the JSON schema of scene files.

use super::print;
use crate::error::AppError;
use crate::scene::file::SceneFile;
use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::Value;

/// Prints the schema.
pub fn schema() -> Result<(), AppError> {
    let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(without_null));
    let schema = settings.into_generator().into_root_schema_for::<SceneFile>();
    let text = serde_json::to_string_pretty(&schema).map_err(|e| AppError::Internal(e.to_string()))?;
    print(&(text + "\n"))
}

/// A key that may be left out may still not be null: TOML has no null, and JSON scenes read the same.
fn without_null(schema: &mut Schema) {
    let null = Value::from("null");
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|t| *t != null);
        if let [single] = types.as_slice() {
            let single = single.clone();
            schema.insert("type".to_owned(), single);
        }
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|choice| choice.get("type") != Some(&null));
        if let [Value::Object(single)] = choices.as_slice() {
            let single = single.clone();
            schema.remove("anyOf");
            single.into_iter().for_each(|(key, value)| drop(schema.insert(key, value)));
        }
    }
}
