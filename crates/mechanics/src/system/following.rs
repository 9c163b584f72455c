//! How the ends of directors follow their unknowns.

use super::director::Directors;
use super::{Elimination, Layout, Relation};

impl Elimination {
    /// Takes the directors of the model.
    pub fn take_directors(&mut self, directors: Directors) {
        self.directors = directors;
    }

    /// The directors of the model.
    #[must_use]
    pub const fn directors(&self) -> &Directors {
        &self.directors
    }

    /// Lets the ends of directors follow their unknowns, (E3), whatever these follow themselves. To be called when all other
    /// relations are made.
    pub fn follow_directors(&mut self, layout: &Layout) {
        let mut relations = Vec::with_capacity(6 * self.directors.all().len());
        for director in self.directors.all() {
            for (end, sign) in director.ends.into_iter().zip([-1.0, 1.0]) {
                for axis in 0..layout.ndim() {
                    let mut relation = Relation {
                        dof: layout.node(end, axis),
                        terms: Vec::with_capacity(2),
                        turns: Vec::new(),
                    };
                    let middle = layout.node(director.middle, axis);
                    let half = layout.node(director.half, axis);
                    self.add_terms(middle, 1.0, layout, &mut relation);
                    self.add_terms(half, sign, layout, &mut relation);
                    relations.push(relation);
                }
            }
        }
        if !relations.is_empty() {
            self.relate_more(layout, relations);
        }
    }
}
