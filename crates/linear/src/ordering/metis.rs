//! Nested dissection and parts of graphs by METIS: the only calls into that library.
//!
//! G. Karypis and V. Kumar, A fast and high quality multilevel scheme for partitioning irregular graphs,
//! SIAM J. Sci. Comput. 20 (1998) 359–392.
#![allow(unsafe_code)]

use super::graph::Graph;
use std::sync::Mutex;

/// METIS draws its random numbers from the C library's one generator: two orderings at once would disturb each other.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

const OPTIONS: usize = metis_sys::METIS_NOPTIONS as usize;

/// The nested dissection order of a graph: `order[new] = old`.
///
/// `None` where METIS gives up, where the graph has no edge (nothing to order) or is too large for its 32 bits.
/// The same graph gives the same order.
///
/// # Limits
/// The graph must be symmetric and without loops, which [`Graph`] guarantees.
pub(super) fn nested_dissection(graph: &Graph) -> Option<Vec<u32>> {
    let Lists {
        mut nvertex,
        mut start,
        mut neighbour,
        mut weight,
    } = Lists::of(graph)?;
    let mut order = vec![0i32; graph.nvertex()];
    let mut place = vec![0i32; graph.nvertex()];

    // SAFETY: every pointer is to a live, exclusively borrowed buffer of the length METIS documents: `options` as `call`
    // has it, `start` nvertex + 1 entries that rise from 0 to the length of `neighbour`, `weight`, `order` and `place`
    // nvertex entries. `Graph` keeps every neighbour below nvertex, without loops, both ways. METIS keeps no pointer, and
    // frees what it allocates. Its one piece of shared state, the generator of random numbers, is behind the lock of
    // `call`.
    let is_well = call(|options| unsafe {
        metis_sys::METIS_NodeND(
            &mut nvertex,
            start.as_mut_ptr(),
            neighbour.as_mut_ptr(),
            weight.as_mut_ptr(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            place.as_mut_ptr(),
        )
    });
    is_well.then(|| order.into_iter().map(|v| v as u32).collect())
}

/// Shares out vertices among so many parts: the part of each, from all neighbours of each. The same graph gives the same
/// parts.
pub(crate) fn share_out<I: Iterator<Item = u32>>(
    nvertex: usize,
    near: impl Fn(u32) -> I,
    nparts: usize,
) -> Vec<u32> {
    let mut start = Vec::with_capacity(nvertex + 1);
    let mut neighbour = Vec::new();
    start.push(0);
    for vertex in 0..nvertex as u32 {
        neighbour.extend(near(vertex));
        start.push(neighbour.len());
    }
    let graph = Graph {
        weight: start
            .windows(2)
            .map(|ends| (ends[1] - ends[0]) as u32 + 1)
            .collect(),
        start,
        neighbour,
    };
    partition(&graph, nparts).unwrap_or_else(|| {
        let part = |vertex: usize| (vertex * nparts / nvertex) as u32;
        (0..nvertex).map(part).collect()
    })
}

/// Parts of a graph with about the same weight and few edges between them: the part of each vertex. `None` as for
/// [`nested_dissection`], and where there are fewer than two parts.
fn partition(graph: &Graph, nparts: usize) -> Option<Vec<u32>> {
    let Lists {
        mut nvertex,
        mut start,
        mut neighbour,
        mut weight,
    } = Lists::of(graph)?;
    let mut nparts = i32::try_from(nparts).ok().filter(|&n| n > 1)?;
    let mut nconstraint = 1;
    let mut cut = 0;
    let mut part = vec![0i32; graph.nvertex()];

    // SAFETY: as in `nested_dissection`; `part` has nvertex entries, the two numbers are live, and METIS takes null for
    // the weights of edges, the sizes of vertices, the shares of parts and the imbalance that it does not get.
    let is_well = call(|options| unsafe {
        metis_sys::METIS_PartGraphKway(
            &mut nvertex,
            &mut nconstraint,
            start.as_mut_ptr(),
            neighbour.as_mut_ptr(),
            weight.as_mut_ptr(),
            std::ptr::null_mut(),
            std::ptr::null_mut(),
            &mut nparts,
            std::ptr::null_mut(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            &mut cut,
            part.as_mut_ptr(),
        )
    });
    is_well.then(|| part.into_iter().map(|p| p as u32).collect())
}

/// Whether a call goes well, with the default options: one at a time, and with the handlers of signals as they were.
fn call(metis: impl FnOnce(&mut [i32; OPTIONS]) -> i32) -> bool {
    let mut options = [0; OPTIONS];
    let _guard = ONE_AT_A_TIME
        .lock()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    #[cfg(target_os = "linux")]
    let _handlers = handlers::Kept::new();
    // SAFETY: `options` has METIS_NOPTIONS entries, borrowed for the call alone.
    unsafe { metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr()) };
    metis(&mut options) == metis_sys::rstatus_et_METIS_OK
}

/// A graph in the numbers of METIS.
struct Lists {
    nvertex: i32,
    start: Vec<i32>,
    neighbour: Vec<i32>,
    weight: Vec<i32>,
}

impl Lists {
    /// `None` where there is no edge, or a number needs more than 32 bits.
    fn of(graph: &Graph) -> Option<Self> {
        if graph.neighbour.is_empty() {
            return None;
        }
        let narrow = |&n: &usize| i32::try_from(n).ok();
        Some(Self {
            nvertex: i32::try_from(graph.nvertex()).ok()?,
            start: graph.start.iter().map(narrow).collect::<Option<_>>()?,
            neighbour: graph.neighbour.iter().map(|&v| v as i32).collect(),
            weight: graph.weight.iter().map(|&w| w as i32).collect(),
        })
    }
}

/// METIS handles SIGABRT and SIGTERM itself while it works, and gives the handlers of the program back without their flags: for
/// one signal only, after which the default action ends the process. So the program keeps them.
///
/// Source: METIS 5.1, GKlib/error.c, `gk_sigtrap` and `gk_siguntrap`; `signal(2)` on the two meanings of `signal`.
#[cfg(target_os = "linux")]
mod handlers {
    const SIGNALS: [libc::c_int; 2] = [libc::SIGABRT, libc::SIGTERM];

    /// The handlers of the program, which come back when this is dropped.
    pub(super) struct Kept([Option<libc::sigaction>; 2]);

    impl Kept {
        pub(super) fn new() -> Self {
            Self(SIGNALS.map(of))
        }
    }

    impl Drop for Kept {
        fn drop(&mut self) {
            for (signal, kept) in SIGNALS.iter().zip(&self.0) {
                if let Some(kept) = kept {
                    // SAFETY: the handler set here is the one set before; the old one is not asked for.
                    unsafe {
                        libc::sigaction(*signal, kept, std::ptr::null_mut());
                    }
                }
            }
        }
    }

    /// The handler of a signal with its flags.
    pub(super) fn of(signal: libc::c_int) -> Option<libc::sigaction> {
        // SAFETY: zeros are a value of this type; the call sets nothing, and writes to a place of that type.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            let failed = libc::sigaction(signal, std::ptr::null(), &raw mut action);
            (failed == 0).then_some(action)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Graph {
        let mut pairs = Vec::new();
        for y in 0..n {
            for x in 0..n {
                let vertex = (y * n + x) as u32;
                if x + 1 < n {
                    pairs.push((vertex, vertex + 1));
                }
                if y + 1 < n {
                    pairs.push((vertex, vertex + n as u32));
                }
            }
        }
        Graph::from_pairs(vec![1; n * n], &pairs)
    }

    #[test]
    fn order_is_a_permutation_and_repeats() {
        for n in [2, 17, 60] {
            let graph = grid(n);
            let order = nested_dissection(&graph).unwrap();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(i, &v)| i == v as usize));
            // also while another thread orders something else
            let (again, _) = rayon::join(
                || nested_dissection(&graph).unwrap(),
                || nested_dissection(&grid(n + 5)).unwrap(),
            );
            assert_eq!(order, again);
        }
    }

    #[test]
    fn parts_are_about_as_large_and_repeat() {
        for nparts in [2, 3, 7] {
            let graph = grid(40);
            let part = partition(&graph, nparts).unwrap();
            for p in 0..nparts as u32 {
                let size = part.iter().filter(|&&of| of == p).count() as f64;
                let mean = 1600.0 / nparts as f64;
                assert!((size - mean).abs() < 0.1 * mean, "{size} of {mean}");
            }
            assert_eq!(part, partition(&graph, nparts).unwrap());
        }
        assert!(partition(&grid(5), 1).is_none());
    }

    #[test]
    fn a_graph_without_edges_is_left_to_others() {
        assert!(nested_dissection(&Graph::from_pairs(vec![1; 5], &[])).is_none());
        assert!(nested_dissection(&Graph::from_pairs(Vec::new(), &[])).is_none());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn handlers_of_signals_are_the_same_afterwards() {
        extern "C" fn nothing(_: libc::c_int) {}
        // the handlers are those of the program only while no thread orders
        let at_rest = || {
            let guard = ONE_AT_A_TIME.lock();
            guard.unwrap_or_else(|poisoned| poisoned.into_inner())
        };
        let set = || {
            let _guard = at_rest();
            // SAFETY: the handler does nothing, and no test raises the signal.
            unsafe {
                let mut action: libc::sigaction = std::mem::zeroed();
                action.sa_sigaction = nothing as extern "C" fn(libc::c_int) as libc::sighandler_t;
                action.sa_flags = libc::SA_RESTART;
                libc::sigaction(libc::SIGTERM, &raw const action, std::ptr::null_mut());
            }
        };
        let seen = || {
            let _guard = at_rest();
            [libc::SIGABRT, libc::SIGTERM].map(|s| {
                let action = handlers::of(s).unwrap();
                (action.sa_sigaction, action.sa_flags & libc::SA_RESTART)
            })
        };
        set();
        let before = seen();
        nested_dissection(&grid(20)).unwrap();
        assert_eq!(seen(), before);
    }
}
