//! A bar of quad4 along x, which may meet a wall at x = 0: E = 900, ρ = 1, 10 long, of section 1, so that waves run at 30.

use std::fmt::Write;

pub const WAVE: f64 = 30.0;
pub const LENGTH: f64 = 10.0;

/// A bar and how it moves.
#[derive(Clone)]
pub struct Bar {
    pub elements: usize,
    /// c h/ℓ.
    pub courant: f64,
    pub gap: f64,
    pub velocity: f64,
    pub increments: usize,
    /// `dynamics = { … }`.
    pub dynamics: &'static str,
    pub contact: String,
    /// Besides its supports: loads of the step, and other tables.
    pub step: String,
    pub nonlinear: bool,
}

impl Default for Bar {
    fn default() -> Self {
        Self {
            elements: 60,
            courant: 0.5,
            gap: 0.0,
            velocity: 10.0,
            increments: 1,
            dynamics: "rho_inf = 0.8",
            contact: "method = \"node-to-segment\"\nenforcement = { lagrange = {} }".into(),
            step: String::new(),
            nonlinear: false,
        }
    }
}

impl Bar {
    pub fn size(&self) -> f64 {
        LENGTH / self.elements as f64
    }

    pub fn h(&self) -> f64 {
        self.courant * self.size() / WAVE
    }

    /// By a penalty of this many E/ℓ.
    pub fn penalty(mut self, times: f64) -> Self {
        let penalty = times * 900.0 / self.size();
        self.contact = format!(
            "method = \"node-to-segment\"\nenforcement = {{ penalty = {penalty:?}, per = \"area\" }}"
        );
        self
    }

    pub fn text(&self) -> String {
        let (mut nodes, mut elements) = (String::new(), String::new());
        for i in 0..=self.elements {
            let x = self.gap + self.size() * i as f64;
            for j in 0..2 {
                write!(nodes, "[{}, {x:?}, {j}.0], ", 2 * i + j + 1).unwrap();
            }
        }
        for i in 0..self.elements {
            let n = 2 * i + 1;
            write!(
                elements,
                "{{ id = {}, type = \"quad4\", group = \"bar\", nodes = [{n}, {}, {}, {}] }}, ",
                i + 1,
                n + 2,
                n + 3,
                n + 1
            )
            .unwrap();
        }
        let geometry = if self.nonlinear {
            "nonlinear"
        } else {
            "linear"
        };
        format!(
            "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
             [material.m]\nmodel = \"linear-elastic\"\nE = 900.0\nnu = 0.0\ndensity = 1.0\n\
             [[body]]\ngroup = \"bar\"\nmaterial = \"m\"\n\
             [sets]\nfoot = {{ faces = [[1, \"-x\"]] }}\nhead = {{ faces = [[{}, \"+x\"]] }}\n\
             [[surface]]\nname = \"wall\"\nshape = {{ plane = {{ point = [0, 0], normal = [1, 0] }} }}\n\
             [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"wall\"\n{}\n\
             [initial]\nvelocity = [{{ on = \"bar\", v = [{:?}, 0] }}]\n\
             [[output.history]]\nname = \"low\"\nset = \"foot\"\nquantity = [\"displacement.x\", \"velocity.x\", \"acceleration.x\"]\n\
             [[step]]\nname = \"go\"\nkind = \"dynamic\"\ngeometry = \"{geometry}\"\nduration = {:?}\n\
             increments = {{ fixed = {} }}\ndynamics = {{ {} }}\nfix = [{{ on = \"bar\", u = [\"y\"] }}]\n{}\n",
            self.elements,
            self.contact,
            -self.velocity,
            self.h() * self.increments as f64,
            self.increments,
            self.dynamics,
            self.step
        )
    }
}
