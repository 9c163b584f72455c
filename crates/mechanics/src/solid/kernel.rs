//! One element: forces, stiffness, energy, stress. Loop bounds are constants here and nowhere else.

#![allow(clippy::needless_range_loop)] // indices are those of tensors, and several arrays share them

use crate::material::{Kinematics, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::element::ReferenceElement;
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// What the kernel of one element type computes.
pub(super) type Kernel = fn(&Element<'_>, Order, &mut Output<'_>) -> Result<(), Failure>;

/// An element with its nodes.
pub(super) struct Element<'a> {
    pub reference: &'a Points,
    pub x: &'a [Vec3],
    pub u: &'a [f64],
    pub material: &'a dyn Material,
    pub kinematics: Kinematics,
    pub thickness: f64,
}

/// Results of one element. Forces and stiffness are those of displacements, node by node.
pub(super) struct Output<'a> {
    pub force: &'a mut [f64],
    pub stiffness: &'a mut [f64],
    pub energy: f64,
    /// Cauchy stress at the quadrature points.
    pub stress: Option<&'a mut [Sym3]>,
    /// Volume belonging to each quadrature point, with `stress`.
    pub volume: &'a mut [f64],
}

/// Why an element has no response.
pub(super) enum Failure {
    Inverted { ratio: f64 },
    Material(MaterialError),
}

impl From<MaterialError> for Failure {
    fn from(error: MaterialError) -> Self {
        match error {
            MaterialError::Inverted { ratio } => Self::Inverted { ratio },
            other => Self::Material(other),
        }
    }
}

/// Derivatives of the shape functions at the quadrature points of a reference element: the same for all its cells.
pub(super) struct Points {
    pub rule: &'static Rule,
    dshape: Vec<Vec3>,
    nnode: usize,
}

impl Points {
    pub fn new(element: &dyn ReferenceElement, rule: &'static Rule) -> Self {
        let nnode = element.nnode();
        let mut dshape = vec![Vec3::ZERO; nnode * rule.npoint()];
        for (xi, dn) in rule.points.iter().zip(dshape.chunks_exact_mut(nnode)) {
            element.dshape(xi, dn);
        }
        Self {
            rule,
            dshape,
            nnode,
        }
    }
}

/// The kernel of an element, by its name.
pub(super) fn kernel(name: &str) -> Option<Kernel> {
    TABLE.iter().find(|(n, _)| *n == name).map(|(_, k)| *k)
}

const TABLE: [(&str, Kernel); 5] = [
    ("tri3", respond::<3, 2, 3>),
    ("quad4", respond::<4, 2, 3>),
    ("tet4", respond::<4, 3, 6>),
    ("hex8", respond::<8, 3, 6>),
    ("wedge6", respond::<6, 3, 6>),
];

/// The strain components that exist: all in space, `xx yy xy` in the plane.
const fn component<const NS: usize>(s: usize) -> usize {
    if NS == 3 && s == 2 { 3 } else { s }
}

fn respond<const NN: usize, const ND: usize, const NS: usize>(
    element: &Element<'_>,
    order: Order,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let finite = element.kinematics == Kinematics::Finite;
    let points = element.reference;
    let n = NN * ND;
    out.energy = 0.0;
    out.force.fill(0.0);
    out.stiffness.fill(0.0);
    let mut response = Response::default();
    let weights = points.rule.weights.iter();
    let at_points = points.dshape.chunks_exact(points.nnode).zip(weights);
    for (point, (dshape, &weight)) in at_points.enumerate() {
        // gradients with respect to the reference configuration
        let mut jacobian = Mat3::ZERO;
        for i in 0..NN {
            for a in 0..ND {
                jacobian.rows[a] += element.x[i] * dshape[i][a];
            }
        }
        if ND == 2 {
            jacobian.rows[2] = Vec3::unit(2);
        }
        let (inverse, det) = jacobian
            .inverse()
            .filter(|(_, det)| *det > 0.0)
            .ok_or_else(|| Failure::Inverted {
                ratio: jacobian.determinant(),
            })?;
        let w = weight * det * element.thickness;
        let mut gradient = [[0.0; ND]; NN];
        let mut h = Mat3::ZERO;
        for i in 0..NN {
            let g = inverse * dshape[i];
            for a in 0..ND {
                gradient[i][a] = g[a];
                let u = element.u[i * ND + a];
                for b in 0..ND {
                    h.rows[a][b] += u * g[b];
                }
            }
        }

        // E = ½(H + Hᵀ + HᵀH)
        let f = if finite {
            Mat3::IDENTITY + h
        } else {
            Mat3::IDENTITY
        };
        let mut value = Sym3::symmetric_part(h);
        let mut ratio = 1.0;
        if finite {
            ratio = f.determinant();
            // not `ratio <= 0`: a ratio that is not a number must not pass
            if ratio.is_nan() || ratio <= 0.0 {
                return Err(Failure::Inverted { ratio });
            }
            value = value + Sym3::gram(h) * 0.5;
        }
        let strain = Strain::new(element.kinematics, value);
        element
            .material
            .respond(&strain, &[], &mut [], order, &mut response)?;
        out.energy += w * response.energy;
        if let Some(stress) = out.stress.as_deref_mut() {
            // (E4)
            stress[point] = if finite {
                response.stress.congruence(f) * ratio.recip()
            } else {
                response.stress
            };
            out.volume[point] = w * ratio;
            continue;
        }

        let s = response.stress.to_pairs();
        let mut b = [[[0.0; ND]; NS]; NN];
        for i in 0..NN {
            let g = &gradient[i];
            for k in 0..NS {
                let (p, q) = Sym3::PAIRS[component::<NS>(k)];
                for a in 0..ND {
                    // (E3)
                    b[i][k][a] = if p == q {
                        f.rows[a][p] * g[p]
                    } else {
                        f.rows[a][p] * g[q] + f.rows[a][q] * g[p]
                    };
                }
            }
            for a in 0..ND {
                let mut sum = 0.0;
                for k in 0..NS {
                    sum += b[i][k][a] * s[component::<NS>(k)];
                }
                out.force[i * ND + a] += w * sum; // (E1)
            }
        }
        if order == Order::Stress {
            continue;
        }
        let mut c = [[0.0; NS]; NS];
        for (k, row) in c.iter_mut().enumerate() {
            for (l, value) in row.iter_mut().enumerate() {
                *value = w * response.tangent[component::<NS>(k)][component::<NS>(l)];
            }
        }
        let full = response.stress.to_mat3();
        for j in 0..NN {
            let mut cb = [[0.0; ND]; NS];
            for k in 0..NS {
                for l in 0..NS {
                    for a in 0..ND {
                        cb[k][a] += c[k][l] * b[j][l][a];
                    }
                }
            }
            let mut sg = [0.0; ND];
            if finite {
                for (p, sg) in sg.iter_mut().enumerate() {
                    for q in 0..ND {
                        *sg += w * full.rows[p][q] * gradient[j][q];
                    }
                }
            }
            for i in j..NN {
                let mut initial = 0.0;
                for p in 0..ND {
                    initial += gradient[i][p] * sg[p];
                }
                for a in 0..ND {
                    let row = &mut out.stiffness[(i * ND + a) * n + j * ND..][..ND];
                    for (d, value) in row.iter_mut().enumerate() {
                        let mut sum = if a == d { initial } else { 0.0 };
                        for k in 0..NS {
                            sum += b[i][k][a] * cb[k][d];
                        }
                        *value += sum; // (E2)
                    }
                }
            }
        }
    }
    if !out.stiffness.is_empty() {
        // the lower blocks are there; the upper ones are their transposes
        for row in 0..n {
            for column in (row / ND + 1) * ND..n {
                out.stiffness[row * n + column] = out.stiffness[column * n + row];
            }
        }
    }
    Ok(())
}
