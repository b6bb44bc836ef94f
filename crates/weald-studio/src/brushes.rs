//! Brushes as a person chooses them, and strokes as the hand makes them.

use weald::edit::{Brush, Effect, Falloff};

/// What a brush does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// None: the pointer moves the camera.
    #[default]
    None,
    /// Adds a material.
    Add,
    /// Takes a material away.
    Remove,
    /// Pours water.
    Water,
    /// Takes water away.
    Dry,
    /// Smooths the ground.
    Smooth,
    /// Brings the ground to the height where the stroke began.
    Level,
    /// Brings the ground to a stated height.
    Flatten,
    /// Lets water rise.
    Spring,
    /// Lets water run off.
    Drain,
    /// Changes the rain.
    Rain,
    /// Holds the simulation still.
    Freeze,
    /// Lets it go on there.
    Thaw,
    /// Protects the ground from other brushes.
    Mask,
    /// Takes that protection away.
    Unmask,
    /// Lets plants stand densely.
    Plant,
    /// Takes plants away.
    Clear,
}

impl Tool {
    /// All brushes, with their names and what they do.
    pub(crate) const ALL: [(Self, &str, &str); 16] = [
        (Self::Add, "Add", "adds a material"),
        (Self::Remove, "Remove", "takes a material away"),
        (Self::Water, "Water", "pours water"),
        (Self::Dry, "Dry", "takes water away"),
        (Self::Smooth, "Smooth", "smooths the ground"),
        (Self::Level, "Level", "brings the ground to the height where the stroke begins"),
        (Self::Flatten, "Flatten", "brings the ground to a stated height"),
        (Self::Spring, "Spring", "lets water rise, in each step"),
        (Self::Drain, "Drain", "lets water run off, in each step"),
        (Self::Rain, "Rain", "changes the rain by a factor"),
        (Self::Freeze, "Freeze", "holds the simulation still"),
        (Self::Thaw, "Thaw", "lets the simulation go on"),
        (Self::Mask, "Mask", "protects the ground from other brushes"),
        (Self::Unmask, "Unmask", "takes the protection away"),
        (Self::Plant, "Plant", "lets grass, ferns or trees stand densely"),
        (Self::Clear, "Clear", "takes grass, ferns or trees away"),
    ];

    /// How densely plants stand where it paints; `None` for a brush that paints on a simulation.
    pub(crate) fn density(self) -> Option<f64> {
        match self {
            Self::Plant => Some(1.0),
            Self::Clear => Some(0.0),
            _ => None,
        }
    }
}

/// What the pressure of a pen changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Pen {
    /// How strongly the brush works.
    #[default]
    Strength,
    /// How wide it is.
    Radius,
    /// Nothing.
    Nothing,
}

impl Pen {
    /// All of them with their names.
    pub(crate) const ALL: [(Self, &str); 3] = [
        (Self::Strength, "changes the strength"),
        (Self::Radius, "changes the radius"),
        (Self::Nothing, "is ignored"),
    ];
}

/// Least part of the radius or of the strength that a pen leaves.
const LIGHTEST: f64 = 0.05;

/// A brush as it is set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Settings {
    /// What it does.
    pub(crate) tool: Tool,
    /// Metres from its middle to its edge.
    pub(crate) radius: f64,
    /// Weight in the middle, 0 to 1.
    pub(crate) strength: f64,
    /// How it falls off towards the edge.
    pub(crate) falloff: Falloff,
    /// Name of the material that it adds or takes away.
    pub(crate) material: String,
    /// Metres of material.
    pub(crate) thickness: f64,
    /// Metres of water.
    pub(crate) depth: f64,
    /// Metres of water a step that rise or run off.
    pub(crate) rate: f64,
    /// Factor on the rain.
    pub(crate) factor: f64,
    /// Elevation to flatten to, in metres.
    pub(crate) height: f64,
    /// What the pressure of a pen changes.
    pub(crate) pen: Pen,
    /// Place of the step whose plants it is about, among those that grow some.
    pub(crate) plants: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tool: Tool::None,
            radius: 100.0,
            strength: 1.0,
            falloff: Falloff::Smooth,
            material: "soil".to_owned(),
            thickness: 5.0,
            depth: 2.0,
            rate: 0.05,
            factor: 3.0,
            height: 0.0,
            pen: Pen::default(),
            plants: 0,
        }
    }
}

impl Settings {
    /// The material that it is about, of those that the ground has: the one that was chosen, or else the last, which is what
    /// settles.
    pub(crate) fn material_of<'a>(&'a self, materials: &'a [String]) -> &'a str {
        let is_there = materials.is_empty() || materials.contains(&self.material);
        if is_there { &self.material } else { materials.last().map_or("", String::as_str) }
    }

    /// What it does in a stroke that began where the ground has this elevation.
    fn effect(&self, ground: f64) -> Option<Effect> {
        let (material, thickness) = (self.material.clone(), self.thickness);
        Some(match self.tool {
            Tool::None => return None,
            Tool::Add => Effect::Add { material, thickness },
            Tool::Remove => Effect::Remove { material, thickness },
            Tool::Water => Effect::AddWater { depth: self.depth },
            Tool::Dry => Effect::RemoveWater { depth: self.depth },
            Tool::Smooth => Effect::Smooth { times: 3 },
            Tool::Level => Effect::Flatten { height: ground },
            Tool::Flatten => Effect::Flatten { height: self.height },
            Tool::Spring => Effect::Source { rate: self.rate },
            Tool::Drain => Effect::Drain { rate: self.rate },
            Tool::Rain => Effect::Rain { factor: self.factor },
            Tool::Freeze => Effect::Freeze,
            Tool::Thaw => Effect::Thaw,
            Tool::Unmask => Effect::Unmask,
            // Of a density only the weights of the brush count.
            Tool::Mask | Tool::Plant | Tool::Clear => Effect::Mask,
        })
    }
}

/// Share of the radius between two places of a stroke: closer ones would touch the same ground.
const SPACING: f64 = 0.25;

/// A stroke in the making.
#[derive(Clone, Debug)]
pub(crate) struct Stroke {
    settings: Settings,
    /// Elevation of the ground where it began.
    ground: f64,
    path: Vec<[f64; 2]>,
    /// How hard the pen is pressed now, and was at most: 1 for a hand without one.
    pressure: f64,
    hardest: Option<f64>,
}

impl Stroke {
    /// Begins at a place, in metres east and south, on ground of this elevation.
    pub(crate) fn new(settings: Settings, at: [f64; 2], ground: f64) -> Self {
        Self { settings, ground, path: vec![at], pressure: 1.0, hardest: None }
    }

    /// The pen is pressed as hard as this, from 0 to 1.
    pub(crate) fn press(&mut self, pressure: f64) {
        self.pressure = pressure.clamp(LIGHTEST, 1.0);
        self.hardest = Some(self.hardest.map_or(self.pressure, |hardest| hardest.max(self.pressure)));
    }

    /// The hand goes on to a place; a straight line leaves out what is between its ends. Gives whether it became another line.
    pub(crate) fn go_on(&mut self, at: [f64; 2], is_straight: bool) -> bool {
        let Some(&last) = self.path.last() else { return false };
        let moved = (at[0] - last[0]).hypot(at[1] - last[1]) >= SPACING * self.settings.radius;
        if is_straight && at != last {
            self.path.truncate(1);
        }
        if moved || is_straight && at != last {
            self.path.push(at);
        }
        moved || is_straight && at != last
    }

    /// How densely plants are to stand along it, where it is about plants.
    pub(crate) fn density(&self) -> Option<f64> {
        self.settings.tool.density()
    }

    /// Where it went.
    pub(crate) fn path(&self) -> &[[f64; 2]] {
        &self.path
    }

    /// The last piece of it as a brush.
    pub(crate) fn piece(&self) -> Option<Brush> {
        self.brush(&self.path[self.path.len().saturating_sub(2)..], self.pressure)
    }

    fn brush(&self, path: &[[f64; 2]], pressure: f64) -> Option<Brush> {
        let effect = self.settings.effect(self.ground)?;
        let Settings { radius, falloff, strength, pen, .. } = self.settings;
        let (radius, strength) = match pen {
            Pen::Strength => (radius, strength * pressure),
            Pen::Radius => (radius * pressure, strength),
            Pen::Nothing => (radius, strength),
        };
        Some(Brush { path: path.to_vec(), radius, falloff, strength, effect })
    }

    /// All of it so far as one brush, as wide and strong as the pen was pressed at most.
    pub(crate) fn whole(&self) -> Option<Brush> {
        self.brush(&self.path, self.hardest.unwrap_or(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_keeps_its_places_apart_however_often_the_hand_reports() {
        let settings = Settings { tool: Tool::Add, radius: 40.0, ..Settings::default() };
        let mut stroke = Stroke::new(settings, [0.0, 0.0], 5.0);
        for place in 0..=1000 {
            stroke.go_on([0.2 * f64::from(place), 0.0], false);
        }
        let brush = stroke.whole().expect("a brush that adds");
        assert!(brush.path.len() <= 21, "{}", brush.path.len());
        assert!(brush.path.windows(2).all(|pair| pair[1][0] - pair[0][0] >= 10.0 - 1e-9));
    }

    #[test]
    fn a_pen_makes_a_stroke_as_strong_or_as_wide_as_it_is_pressed() {
        let of = |pen: Pen| {
            let settings =
                Settings { tool: Tool::Add, pen, radius: 40.0, strength: 0.8, ..Settings::default() };
            let mut stroke = Stroke::new(settings, [0.0, 0.0], 5.0);
            stroke.press(0.5);
            stroke.go_on([100.0, 0.0], false);
            stroke.press(0.25);
            let told =
                |brush: Option<Brush>| brush.map(|brush| [brush.radius, brush.strength]).expect("a brush");
            [told(stroke.whole()), told(stroke.piece())]
        };
        assert_eq!(of(Pen::Strength), [[40.0, 0.4], [40.0, 0.2]], "the hardest press, and that of now");
        assert_eq!(of(Pen::Radius), [[20.0, 0.8], [10.0, 0.8]]);
        assert_eq!(of(Pen::Nothing), [[40.0, 0.8]; 2]);
    }

    #[test]
    fn levelling_keeps_the_height_of_where_it_began_and_a_line_is_straight() {
        let settings = Settings { tool: Tool::Level, ..Settings::default() };
        let mut stroke = Stroke::new(settings, [10.0, 10.0], 123.0);
        stroke.go_on([500.0, 300.0], true);
        stroke.go_on([700.0, 400.0], true);
        let brush = stroke.whole().expect("a brush that levels");
        assert_eq!(brush.effect, Effect::Flatten { height: 123.0 });
        assert_eq!(brush.path, [[10.0, 10.0], [700.0, 400.0]]);
        assert!(Stroke::new(Settings::default(), [0.0, 0.0], 0.0).whole().is_none(), "no tool");
    }
}
