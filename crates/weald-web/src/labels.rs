//! Where everything with a label is, as a screen reader would say it: for scripts that use the page as a person does.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::accesskit::{Node, NodeId, Role, TreeUpdate};
use eframe::egui::{Context, FullOutput, Plugin};

/// The last tree of labels.
#[derive(Clone, Default)]
pub(crate) struct Labels {
    nodes: Arc<Mutex<HashMap<NodeId, Node>>>,
}

impl Labels {
    /// West, north, east and south of everything of that label, in points of the canvas.
    pub(crate) fn places(&self, label: &str) -> Vec<[f64; 4]> {
        let nodes = self.nodes.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |node: &&Node| {
            let text = if node.role() == Role::Label { node.value() } else { node.label() };
            text == Some(label)
        };
        let bounds = nodes.values().filter(is_it).filter_map(Node::bounds);
        bounds.map(|bounds| [bounds.x0, bounds.y0, bounds.x1, bounds.y1]).collect()
    }

    fn take(&self, update: &TreeUpdate) {
        // Every update is of the whole tree.
        *self.nodes.lock().unwrap_or_else(PoisonError::into_inner) = update.nodes.iter().cloned().collect();
    }
}

impl Plugin for Labels {
    fn debug_name(&self) -> &'static str {
        "labels"
    }

    fn setup(&mut self, context: &Context) {
        context.enable_accesskit();
    }

    fn output_hook(&mut self, _: &Context, output: &mut FullOutput) {
        if let Some(update) = &output.platform_output.accesskit_update {
            self.take(update);
        }
    }
}
