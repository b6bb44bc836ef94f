//! Commented recipes to start from: `weald new`.

/// A recipe to start from.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// Word after `--template`.
    pub name: &'static str,
    /// What it makes, in one sentence.
    pub summary: &'static str,
    /// The recipe.
    pub text: &'static str,
}

/// All templates; the first is taken where none is named.
pub const TEMPLATES: &[Template] = &[
    Template {
        name: "highland",
        summary: "fractal ground, carved by floods until rivers and valleys stand",
        text: include_str!("template/highland.toml"),
    },
    Template {
        name: "fault",
        summary: "fault formation, weathered to slopes that rest",
        text: include_str!("template/fault.toml"),
    },
    Template {
        name: "layers",
        summary: "a river through hard and soft beds, with slides from its banks",
        text: include_str!("template/layers.toml"),
    },
    Template {
        name: "dem",
        summary: "a real elevation model under rain",
        text: include_str!("template/dem.toml"),
    },
    Template {
        name: "range",
        summary: "a mountain range that rose for millions of years while rivers cut it",
        text: include_str!("template/range.toml"),
    },
    Template {
        name: "island",
        summary: "an island that rose from the sea, with rivers, cliffs and beaches",
        text: include_str!("template/island.toml"),
    },
    Template {
        name: "fjord",
        summary: "a coast of drowned valleys, which rivers cut before the land sank",
        text: include_str!("template/fjord.toml"),
    },
    Template {
        name: "delta",
        summary: "mountains by a shallow sea, with a plain and deltas of what rivers brought down",
        text: include_str!("template/delta.toml"),
    },
    Template {
        name: "volcano",
        summary: "a volcano with a crater, and the gullies that rain has cut into its flanks",
        text: include_str!("template/volcano.toml"),
    },
    Template {
        name: "canyon",
        summary: "a plateau of hard and soft beds that rises, and the canyons that its rivers saw into it",
        text: include_str!("template/canyon.toml"),
    },
    Template {
        name: "meadow",
        summary: "a meadow by a lake, with grass, ferns and trees where they find what they need",
        text: include_str!("template/meadow.toml"),
    },
];

/// The template of that name; an error says which there are.
pub fn find(name: &str) -> Result<&'static Template, String> {
    TEMPLATES.iter().find(|template| template.name == name).ok_or_else(|| {
        let known: Vec<_> =
            TEMPLATES.iter().map(|template| format!("{} ({})", template.name, template.summary)).collect();
        format!("there is no template {name:?}; there are: {}", known.join(", "))
    })
}
