//! All codes of messages, with what `signorini explain` says about them.
//!
//! | code  | about                                        | exit code |
//! |-------|----------------------------------------------|-----------|
//! | S01xx | the text of a case or deck                   | 3         |
//! | S02xx | references, meshes                           | 3 or 4    |
//! | S03xx | the model as a whole                         | 4         |
//! | S04xx | plausibility                                 | – (warnings) |
//! | S05xx | the course of a solution                     | 5         |
//! | S06xx | writing results                              | 6, or 3   |
//! | S07xx | going on with a run                          | 7         |
//! | S08xx | limits                                       | 8         |
//! | S09xx | several processes                            | 70        |
//!
//! What is once released under a code keeps its meaning.

/// How a run ends on an error of this kind, in the order of a run's life.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// The input is wrong; nothing was solved.
    Input,
    /// The model is ill-posed; nothing was solved.
    Model,
    /// A solution did not converge; what had converged is on disk.
    Convergence,
    /// Results could not be written.
    Output,
    /// A run cannot go on from where it stopped.
    Restart,
    /// A limit was reached; the run can go on.
    Limit,
    /// The program itself fails, or the processes of a run do.
    Internal,
}

impl Class {
    /// The exit code of the program.
    pub fn exit_code(self) -> u8 {
        match self {
            Class::Input => 3,
            Class::Model => 4,
            Class::Convergence => 5,
            Class::Output => 6,
            Class::Restart => 7,
            Class::Limit => 8,
            Class::Internal => 70,
        }
    }
}

/// A kind of finding, and what there is to say about it.
#[derive(Debug, PartialEq, Eq)]
pub struct Code {
    /// The code itself, as in `S0102`.
    pub id: &'static str,
    /// How a run ends on it.
    pub class: Class,
    /// What it is, in a few words.
    pub title: &'static str,
    /// What happened.
    pub meaning: &'static str,
    /// Why that may be.
    pub reasons: &'static [&'static str],
    /// What to do.
    pub remedies: &'static [&'static str],
}

impl Code {
    /// The entry of a code such as `S0102`; letters may be small.
    ///
    /// # Example
    /// ```
    /// use signorini_io::diagnostic::codes::Code;
    ///
    /// let code = Code::find("s0302").ok_or("no such code")?;
    /// // a body that moves freely is a fault of the model
    /// assert_eq!(code.class.exit_code(), 4);
    /// # Ok::<(), &str>(())
    /// ```
    pub fn find(id: &str) -> Option<&'static Code> {
        ALL.iter()
            .copied()
            .find(|code| code.id.eq_ignore_ascii_case(id))
    }

    /// What `signorini explain` prints.
    pub fn explanation(&self) -> String {
        let mut text = format!("{}: {}\n\n{}\n", self.id, self.title, self.meaning);
        for (heading, lines) in [
            ("Possible reasons", self.reasons),
            ("What to do", self.remedies),
        ] {
            text.push_str(&format!("\n{heading}\n"));
            for line in lines {
                text.push_str(&format!("  * {line}\n"));
            }
        }
        text
    }
}

macro_rules! codes {
    ($( $name:ident $id:literal $class:ident $title:literal
        $meaning:literal
        [ $($reason:literal),* $(,)? ]
        [ $($remedy:literal),* $(,)? ] )*) => {
        $(
            #[doc = concat!($id, ": ", $title, ".")]
            pub static $name: Code = Code {
                id: $id,
                class: Class::$class,
                title: $title,
                meaning: $meaning,
                reasons: &[$($reason),*],
                remedies: &[$($remedy),*],
            };
        )*
        /// Every code, in order.
        pub static ALL: &[&Code] = &[$(&$name),*];
    };
}

codes! {
    EMPTY "S0101" Input "the file is empty"
    "The file holds nothing but blank lines and comments."
    ["the wrong file was named", "the program that wrote it was stopped or ran out of disk space"]
    ["start from a template: signorini init"]

    UNKNOWN_KEY "S0102" Input "unknown key"
    "A key stands where the case format knows none of that name. Keys are never skipped in silence: a mistyped \
     friction coefficient would otherwise go unnoticed."
    ["a typing error", "the key belongs into another table", "the case was written for a newer version"]
    ["take the key that the message proposes", "see all keys: signorini schema", "delete the line"]

    NOT_TEXT "S0103" Input "the file is not text in UTF-8"
    "A case is text in the encoding UTF-8. This file holds bytes that cannot be such text."
    ["a binary file was named (a mesh, an archive, a result)", "an editor saved the file as UTF-16 or Latin-1"]
    ["name the case file", "save the file as UTF-8, in Windows Notepad: Save as, Encoding: UTF-8"]

    SYNTAX "S0104" Input "the text breaks the rules of TOML"
    "The text cannot be read as TOML near the place shown, whatever the keys in it mean."
    ["a quote, bracket or comma is missing or too much", "a text value has no quotes", "the file is cut off"]
    ["look at the place shown and at the line before it", "TOML in ten minutes: https://toml.io"]

    TWICE "S0105" Input "a key or table is given twice"
    "The same key stands twice in one table, or the same table is opened twice. Neither of the two wins: it would \
     depend on luck which one was meant."
    ["a line was copied and the original not deleted", "`[table]` was written for a list, where `[[table]]` adds an entry"]
    ["delete or rename one of the two"]

    MISSING "S0106" Input "something required is missing"
    "A key without which the case means nothing is absent. Only geometry, materials, supports and names have no default."
    ["the key was forgotten or commented out", "it was mistyped and is reported as unknown too"]
    ["add the key at the place shown"]

    WRONG_TYPE "S0107" Input "a value of the wrong type"
    "The value is of another kind than its key takes, such as text where a number belongs."
    ["a number stands in quotes", "a single value stands where a list belongs, or the other way round"]
    ["write the value as the message shows"]

    NOT_FINITE "S0108" Input "not a finite number"
    "The value is not a number one can compute with: NaN, infinite, larger than 1.8e308, or so small (below 2.2e-308) \
     that digits are lost."
    ["a script divided by zero while it wrote the case", "an exponent was mistyped"]
    ["write a finite number"]

    OUT_OF_RANGE "S0109" Input "a number outside its range"
    "The value has no meaning for its key, such as a negative stiffness or Poisson's ratio of an incompressible material."
    ["a sign or an exponent was mistyped", "two values were swapped"]
    ["choose a value in the range that the message names"]

    NOT_A_CHOICE "S0110" Input "a word that is not one of the choices"
    "The key takes one of a few words, and this is none of them."
    ["a typing error", "the word is what another program calls it"]
    ["take one of the words that the message lists"]

    NOT_BUILT "S0111" Input "known, but not supported yet"
    "The case format has a meaning for this, but this version cannot do it. It is refused, because ignoring it would \
     give an answer to another question."
    ["the case was written for a newer version", "the manual describes a later version",
     "the program was built without an optional part"]
    ["take what the message proposes instead", "delete the line", "look for a newer version",
     "build the program with that part"]

    CONTRADICTION "S0112" Input "keys that exclude each other, or need each other"
    "Of several keys exactly one (or at most, or at least one) may be given, and that is not so here."
    ["two ways of saying the same were mixed", "all of them were left out"]
    ["keep the one that is meant"]

    NAME_TWICE "S0113" Input "two things with one name"
    "Sets, bodies, surfaces and references share one name space; contacts, steps and histories have one each. A name \
     that stands for two things stands for none."
    ["an entry was copied and its name not changed"]
    ["rename one of the two"]

    UNDEFINED "S0114" Input "reference to something undefined"
    "A name is used that nothing in the case defines."
    ["a typing error", "the definition was deleted, renamed or commented out"]
    ["take one of the names that the message lists", "define it"]

    NOT_A_NUMBER "S0115" Input "a number was expected"
    "The text at the place shown looks like a number but is not one. Most often it has a decimal comma."
    ["a decimal comma instead of a point", "a unit or other letters behind the number"]
    ["write 0.3, not 0,3", "leave units away: `units` says them once"]

    WRONG_LENGTH "S0116" Input "a list of the wrong length or form"
    "A list has more or fewer entries than its key takes, such as two coordinates for a point."
    ["a decimal comma splits one number in two", "a bracket is missing", "an entry was forgotten"]
    ["write the list as the message shows"]

    NOT_INCREASING "S0117" Input "a table whose first column does not increase"
    "A table is read from its first row to its last; its first column, such as time, must increase from row to row."
    ["rows were swapped or doubled", "a jump was written as two rows of one time"]
    ["sort the rows", "write a jump as two rows a small time apart"]

    TOO_DEEP "S0118" Input "nested too deep"
    "Lists or tables stand inside each other more than eighty deep. No case needs more than six."
    ["brackets were opened and never closed", "the file was made to break programs"]
    ["look for the first bracket that is not closed"]

    NEWER_FORMAT "S0119" Input "the case is written for another format"
    "`format` says which version of the case format a file follows. This program knows version 1."
    ["the case was written for a newer version of the program"]
    ["install a newer version", "check that the number was not changed by mistake"]

    BAD_OVERRIDE "S0120" Input "--set names nothing in the case"
    "`--set path=value` changes one value of the case. The path leads from table to table, separated by points; \
     entries of lists are found by name or by number, the first one being 0."
    ["a typing error in the path", "the entry has another name in the file"]
    ["take one of the names that the message lists", "quote names with points in them: material.\"St 37.2\".E"]

    UNREADABLE "S0121" Input "a file cannot be read"
    "The file does not exist, is a directory, or may not be read."
    ["the name was mistyped or is relative to another directory", "permissions"]
    ["check the name and the directory that the message shows"]

    NOT_BROUGHT "S0122" Input "own physics that the program does not have"
    "The case names a surface, law, material or function of time by `own`. Such things are code of the program that made \
     the case; no file holds them."
    ["the case is run by another program, such as the command `signorini`", "the program calls it by another name"]
    ["run the case from the program that made it", "take a surface, law, material or table of the case in its place"]

    NOT_IN_MESH "S0201" Input "the mesh has nothing of that name"
    "A case refers to groups of its mesh and to its own sets by name. This name is neither."
    ["a typing error", "the group was not exported (Gmsh writes only physical groups)", "case matters in .msh files"]
    ["list the names: signorini info MESH", "take one of the names that the message lists"]

    BAD_MESH "S0202" Input "the mesh cannot be used"
    "The mesh is damaged, contradicts itself, or holds elements that are not known."
    ["the file was cut short or edited", "an element type that is not supported", "only the surface was saved"]
    ["export the mesh again", "look at it: signorini info MESH"]

    WRONG_KIND "S0203" Input "a set of the wrong kind"
    "Contact and pressure need faces, a body needs solid elements, a support needs nodes, and only references and rigid \
     bodies turn. This set is of another kind."
    ["a set of nodes where a surface is needed", "a group of curves or points", "a surface group without solids behind it",
     "rotations of the nodes of a solid"]
    ["name another set", "list what is in the sets: signorini info MESH"]

    MESH_NOTE "S0204" Input "something about the mesh worth knowing"
    "The mesh can be used, but something in it is unusual."
    ["nodes without elements", "nodes at the same place that are not merged"]
    ["look at it: signorini check CASE", "silence with  allow = [\"S0204\"]  if it is meant so"]

    BAD_ELEMENTS "S0211" Model "elements with zero or negative volume"
    "Elements are turned inside out or flat, or their temperature at the start would shrink them to nothing. No solver can use \
     them."
    ["nodes in another order than the format says", "mid-side nodes of curved elements moved too far", "a mirrored mesh",
     "an expansion in other units than temperatures"]
    ["look at the elements in check.vtu", "remesh, or curve the elements less", "correct the expansion of the material"]

    HELD_BY_CONTACT "S0301" Model "a body held only by contact"
    "Nothing but contact keeps the body in place, and the contact is open at the start."
    ["a small gap in the drawing or from meshing", "a support was forgotten"]
    ["close the gap:  start = { close_gaps_below = LENGTH }  of the contact",
     "prescribe the motion of the body instead of a load", "hold it by a support",
     "where  stabilize = false  is the reason, delete it"]

    FREE_BODY "S0302" Model "a body that nothing holds"
    "The body can move without any force. Its equations have no unique solution."
    ["a support or a contact was forgotten", "a support holds too few directions"]
    ["fix the body in enough directions", "prescribe its motion", "bring it into contact",
     "where no load acts on the motion:  free_motions = \"hold\"  in [solver]"]

    BAD_SIDES "S0303" Model "two sides of a contact that cannot touch"
    "The sides share nodes, are the same, are both rigid, or are not what the method of the contact needs."
    ["the meshes of the two bodies were merged", "the same set was named twice", "a rigid tool against a rigid base",
     "bare nodes where a method averages normals of faces"]
    ["mesh the bodies apart, without common nodes", "name two different sides", "give one body a material",
     "the key that the message proposes"]

    NOTHING_TO_SOLVE "S0304" Model "nothing to solve for"
    "No body has a material, so that nothing can deform."
    ["all bodies are rigid"]
    ["give a body a material"]

    CLASH "S0305" Model "supports or motions that contradict each other"
    "One displacement is prescribed twice in one step, differently, or on a node of a rigid body."
    ["two sets of supports overlap", "a node of a rigid body is named instead of the body"]
    ["take the nodes out of one of the sets", "free the set first", "support or move the rigid body itself"]

    BOTH_BODIES "S0306" Model "an element or a node in two bodies"
    "Every element belongs to one body, every node of a rigid body to no other rigid body."
    ["groups that overlap"]
    ["name groups that do not overlap"]

    BAD_LOAD "S0307" Model "a load that cannot act"
    "The load has nothing to act on: its faces have no area, its nodes cannot carry a moment, its elements are in no body."
    ["a set that is smaller than it was meant", "a moment on nodes in one line", "a group that no body is made of"]
    ["name another set", "look at what is in the sets: signorini info MESH"]

    BAD_CONSTRAINT "S0308" Model "constraints that cannot hold"
    "Constraints, supports and rigid bodies contradict each other, or bind the same displacement twice."
    ["a node is bound by two constraints", "a bound node is supported too", "a reference without nodes",
     "nodes at one place, or on one line, that cannot turn", "nodes of a plane or line that are not on it"]
    ["take the node out of one of the sets", "support the reference, not the nodes that follow it", "name other nodes"]

    BAD_SURFACE "S0309" Model "a surface that cannot be"
    "The numbers or triangles of a [[surface]] describe no surface with an outside."
    ["a polynomial of a high degree", "triangles that are turned inside out", "triangles whose corners lie on a line"]
    ["correct the numbers, as the message says", "repair the file of triangles"]

    DEEP_OVERLAP "S0312" Model "sides that overlap too deeply at the start"
    "Two sides overlap at the start by more than half the thickness of the bodies there, measured along the inward normal to \
     their other side. An interference within that is resolved over the first step; deeper, nothing says on which side the \
     bodies are to come apart."
    ["a body is in the wrong place", "the case mixes units of length", "a contact that is meant for a later step"]
    ["move the body, or correct the mesh", "switch the contact on later:  active = false  and  [[step.contact]]",
     "for an interference that is meant so:  start = { interference = \"now\" }  of the contact, or  \"increments\""]

    IMPLAUSIBLE "S0402" Input "a value that does not fit the units"
    "A material value would be far outside of what materials have, if the units of the case are what its label says. \
     Nothing is converted: numbers are used as they are."
    ["a value in Pa in a model in millimetres and newtons (MPa)", "`units` does not say what the numbers are in"]
    ["convert the value", "correct `units`", "silence with  allow = [\"S0402\"]  if it is meant so"]

    STRANGE_UNITS "S0403" Input "a label of units that is not understood"
    "The label names length, force and stress, separated by hyphens, such as mm-N-MPa. Where it cannot be understood, or \
     its stress is not its force over its squared length, plausibility is not checked. Nothing else depends on it."
    ["a typing error", "a mixture of units"]
    ["write one of mm-N-MPa, m-N-Pa, m-MN-MPa, um-uN-MPa"]

    STIFF_ELEMENTS "S0404" Model "linear triangles, tetrahedra or wedges"
    "Strain is constant, or nearly so, within linear triangles, tetrahedra and wedges. In bending they are too stiff by a \
     large factor unless there are many over the thickness, and near incompressibility they lock."
    ["the mesher's default is elements of first order"]
    ["mesh with quad4 or hex8, or with elements of second order (tri6, tet10)", "refine until the answer stays the same",
     "silence with  allow = [\"S0404\"]  if it is meant so"]

    NO_EFFECT "S0405" Input "something without effect"
    "The case says something that changes nothing, such as temperatures where no material expands, or a step without any \
     change."
    ["something it belongs to was forgotten", "it was left over from another case"]
    ["add what is missing, as the message says", "delete it", "silence with  allow = [\"S0405\"]  if it is meant so"]

    UNUSUAL "S0406" Input "an unusual value"
    "The value can be computed with, but hardly anything has one like it."
    ["a decimal point was forgotten", "a value in percent", "a large number stands for no slip at all"]
    ["correct the value", "for sides that never slip:  tied = true",
     "silence with  allow = [\"S0406\"]  if it is meant so"]

    PAIR_TWICE "S0407" Input "two contacts of one pair"
    "Two contacts have the same two sides, in one order or the other. Where both act at a time both push, so that the \
     stiffness is that of both."
    ["an entry was copied and its sides not changed", "the second was meant to look at the other side's points"]
    ["delete one of the two", "write  passes = 2  to look at the points of both sides",
     "silence with  allow = [\"S0407\"]  where they act in different steps"]

    OVERLAP "S0411" Input "sides that overlap at the start"
    "Nodes of one side lie inside the other at the start, by more than straight facets of curved surfaces explain. They are \
     taken for an interference fit, unless `start` says otherwise: it is resolved over the first step in which the contact \
     acts."
    ["an interference fit, as it is meant", "bodies that were placed inaccurately"]
    ["nothing, where it is meant so: silence with  allow = [\"S0411\"]", "without stress:  start = { interference = \"strain-free\" }",
     "by moving nodes:  start = { close_gaps_below = LENGTH }"]

    FACETED "S0412" Input "gaps that come from straight facets"
    "Curved surfaces that conform, meshed with linear elements that do not match, have gaps and overlaps of the height of an \
     arc above its chord. They come from the mesh. Gaps are measured between the curved surfaces that the facets were cut \
     from, as their neighbours turn; a uniform clearance or interference stays, however small."
    ["a shaft in a hole, meshed with linear elements of different sizes"]
    ["nothing; silence with  allow = [\"S0412\"]", "to take the gaps of the facets:  start = { facets = \"straight\" }"]

    NEVER_CLOSED "S0413" Input "a contact that never closed"
    "The run has ended, and the two sides of the contact have touched in no increment."
    ["a motion that is too short, or goes the other way", "a set that names other faces", "a mistake in the units of length"]
    ["look at the largest motions and at the gap in history.csv", "silence with  allow = [\"S0413\"]  if it is meant so"]

    OPEN_EDGE "S0414" Input "a contact that ends at an edge of its body"
    "The faces of the secondary side end at a convex edge of the body, over a face of the other side. With friction the edge \
     may roll under; the face next to it is not in the contact, and passes through the other side unseen."
    ["the set has the lower face of a block, and not its flanks"]
    ["add the faces next to the edge to the secondary side", "silence with  allow = [\"S0414\"]  where the edge does not roll"]

    IDLE_ROWS "S0415" Input "contact at nodes that are prescribed"
    "Where both sides of a contact are prescribed, or follow what is, a pressure or friction between them acts on nothing that \
     moves: nothing says how large it is. It is left out, and is in none of the forces of supports and contacts there."
    ["supports and motions that go up to the edge of a contact", "a block whose sides are held, on another whose sides are"]
    ["nothing, where those forces are of no interest", "take the supports off the nodes of the contact"]

    CONTACT_FOUND "S0416" Input "contact that begins in a run"
    "With  all = true  the program finds what may touch: at the start, and after every increment. What it finds during the run \
     is named with the time. Where the bodies were inside one another already, the increment was done again with them in \
     contact."
    ["bodies, or parts of one, came near one another"]
    ["nothing needs to be done", "exclude what is not meant to touch:  exclude = [[\"a\", \"b\"]]"]

    UNRESOLVED_ZONE "S0418" Input "a joint that breaks within few facets"
    "A cohesive joint transmits tractions in a zone behind the tip of a crack, whose length follows from modulus, toughness, \
     strength and thickness. Where fewer than seven facets lie in it, forces are wrong by percents, and increments fail."
    ["a high strength, which makes the zone short", "a coarse mesh along the joint"]
    ["smaller facets along the joint", "a lower strength of both modes, as the message says: the energy stays the same",
     "silence with  allow = [\"S0418\"]"]

    VISCOUS_JOINT "S0419" Input "viscosity took much of the energy of a joint"
    "The `viscosity` of a cohesive joint delays damage, so that increments converge. Its work is an energy that the joint does \
     not have: more than 1 % of what damage has taken is a wrong load."
    ["a `viscosity` that is long compared with the time in which a row breaks", "increments that are too few"]
    ["a smaller `viscosity`, or none", "slower loading: a longer step", "smaller facets along the joint, which need none",
     "silence with  allow = [\"S0419\"]"]

    PRESSED_APART "S0421" Input "contact pressure where the surfaces are apart"
    "Accepted states are audited point by point, whatever the method. Nodes carry contact pressure, and nowhere around them \
     is the gap zero: the pressure is not that of surfaces that touch."
    ["a corner or an edge of the other side lies over a facet, and a mean over the facet counts as a gap",
     "a body meets its own far side, or a surface beyond the one in front"]
    ["compare single points:  method = \"node-to-segment\"", "a smaller `reach`", "smaller facets at corners and edges",
     "make it an error:  --strict"]

    INSIDE "S0422" Input "one side of a contact is inside the other"
    "Accepted states are audited point by point. Points of one side are inside the other, by more than the law of the contact \
     and the facets explain."
    ["the coarser side is the secondary one, so that corners of the other side are not looked at",
     "a point went through in one increment", "the penalty is too soft"]
    ["exchange secondary and primary, or  passes = 2", "smaller increments", "a larger penalty, or  enforcement = \"lagrange\"",
     "make it an error:  --strict"]

    WRONG_DIRECTION "S0423" Input "contact tractions in a direction that friction does not allow"
    "Accepted states are audited. Measured along the normal of the primary side at the closest points, tractions have more \
     shear than friction allows, or less where they slip."
    ["facets have tilted against the other side, as at a corner that rolls up, and pressure acts along their normals"]
    ["compare single points:  method = \"node-to-segment\"", "take the faces next to the edge into the secondary side",
     "smaller facets there", "make it an error:  --strict"]

    NOT_CARRIED "S0424" Input "contact tractions that no stress carries"
    "Accepted states are audited. Contact exerts tractions that the stress of the elements there does not balance: they go \
     from the contact into a support, or cancel each other."
    ["a node is joined and held, or held by two joints", "very few elements at the contact"]
    ["take the supports off the nodes that are joined, or exchange the sides", "smaller elements at the contact",
     "make it an error:  --strict"]

    LED_BY_VISCOSITY "S0425" Input "viscous forces did much of the work"
    "There was no equilibrium nearby, or none was found, and viscous forces led to another one. Their work is a large part of \
     that of loads and supports: where the structure does not snap, the state that was reached may not be the right one."
    ["the structure snaps or buckles", "an increment was too large for contact or friction"]
    ["prescribe a motion instead of the load", "hold what is free", "smaller increments:  increments = { max = ... }",
     "refuse such steps:  on_trouble = [\"cut\"]", "make it an error:  --strict"]

    NOT_STOPPED "S0426" Input "a body that moved freely, and that nothing stopped"
    "A body that only contact holds was pushed away by others, or by what moves it, and at the end of the motion nothing \
     presses against it from the other side. Any place farther away would do as well: where it is, is no result."
    ["a support is missing", "a contact pair is missing, the one that would stop it",
     "a body that is pushed in a direction in which there is no friction"]
    ["hold it by [[step.fix]], or prescribe its motion by [[step.move]]", "add the contact that stops it",
     "give the contact that moves it friction", "make it an error:  --strict"]

    ENERGY_ADDED "S0427" Input "a method of going through time that added energy"
    "The energy of a motion is that at the start and the work of supports and loads, less what friction and damping spend. What \
     is there is more: where contact flickers, or an increment is far too long, the method of the step adds some, and the forces \
     are of its making."
    ["`alpha`, or rho_inf = 1, with hard contact", "increments that are long for what moves fast"]
    ["let high frequencies go:  dynamics = { rho_inf = 0.8 }", "nodes without mass:  contact_mass = \"redistributed\"",
     "shorter increments", "make it an error:  --strict"]

    UNSTABLE_STATE "S0428" Input "natural modes about a state that is not stable"
    "Natural modes are small motions about a state of equilibrium. Some of these do not swing: they grow, as the state gives way \
     to a force in their direction. Their frequencies, the roots of something below zero, are written below zero."
    ["a body that is compressed beyond its buckling load", "a body that only contact holds, which is not closed"]
    ["less load in the steps before it", "supports against the motion that grows: see its shape in modes.pvd"]

    NOT_COUNTED "S0429" Input "natural frequencies that were not counted"
    "A factor of the stiffness, less the mass times a squared frequency, says how many natural frequencies are below that one. \
     Where it does not agree with those that were found, or has no signs, some of them may be missing from the list. Those in it \
     are as good as their residuals say."
    ["redundant multipliers, as of contacts and supports at the same nodes", "frequencies that nearly coincide at the end of the list"]
    ["ask for a few more or fewer `modes`", "another method of enforcing the contact: a penalty"]

    UNSYMMETRIC "S0430" Input "a stiffness that is not symmetric"
    "Natural modes are those of the symmetric part of the stiffness. What is left out may couple them, and make some grow."
    ["pressures that follow surfaces whose edges are free", "remedies against locking at finite strain", "friction"]
    ["nothing, where the part is small", "silence with  allow = [\"S0430\"]"]

    FAR_FROM_START "S0431" Input "a contact that slid far in the geometry of the start"
    "A contact whose steps all have linear geometry compares the sides where they were at the start. What touches has moved \
     along the other side by more than a facet since, so that it presses on facets that are no longer opposite."
    ["bodies that slide, roll or turn far", "a load that nothing but friction holds"]
    ["where motions are large:  geometry = \"nonlinear\"  in the steps",
     "to follow the motion at small strain:  sliding = \"finite\"  of the contact",
     "silence with  allow = [\"S0431\"]  where both sides are plane and wide"]

    WORN_DEEP "S0432" Input "a contact that is worn deep"
    "Wear changes the gap that a contact sees, and moves no node: the shape of the bodies behind it, their thickness and the normals \
     stay as they were. That is right as long as depths are small against the elements and their slope along the surface is small."
    ["a coefficient of wear in other units than pressures are", "a long way, or many cycles"]
    ["read results up to a depth of `limit` elements", "a coarser mesh at the contact, where it resolves the pressure",
     "a larger `limit` of  contact.wear, or  allow = [\"S0432\"]"]

    LEAKS "S0436" Input "a fluid that has come through a contact"
    "The fluid between the sides has reached the rim where it did not come from: the contact does not seal. The pressure \
     beyond the rim is not known, and what the contact is loaded by from then on is an assumption."
    ["the pressure of the fluid is more than what presses the sides together holds",
     "`from` names some of the nodes only where the fluid is from the start, and others are at the rim, too"]
    ["look at `contact_wet` in the results for the way it took", "press the sides together harder",
     "silence with  allow = [\"S0436\"]  where it is meant to leak"]

    HEAT_LOST "S0437" Input "heat that is lost or made"
    "In every increment that finds temperatures, the heat that comes in by loads, held temperatures, rigid surfaces and friction is \
     added up, and what bodies store is taken off. What remains is more than rounding and the tolerance of Newton's method explain: \
     temperatures of these increments are not in balance."
    ["a coarse `force_tol` of Newton's method", "one part of the model takes up far less heat than another, and is solved for coarsely"]
    ["a smaller tolerance:  newton = { force_tol = 1e-12 }  in [solver]", "smaller increments", "make it an error:  --strict"]

    OVERSHOOT "S0438" Input "increments in which temperatures overshoot"
    "A body stores heat between its nodes, as the shape functions of its elements have it. Where a temperature jumps, as at a support \
     that a transient step heats at once, the nodes next to it first go the other way, unless heat gets across an element in an \
     increment: k Δt/(ρ c h²) has to be 1/6 at least."
    ["short increments at the start of a step, with coarse elements where heat comes in"]
    ["store heat at nodes, where temperatures hardly overshoot:  capacity = \"lumped\"  of the body", "longer increments, or smaller elements",
     "silence with  allow = [\"S0438\"]  where temperatures come in gradually"]

    ODD_FOURIER "S0439" Input "heat that goes unusually far in an increment"
    "In an increment, heat goes about √(k Δt/(ρ c)) far. That is less than a thousandth of the smallest element of a body, or \
     more than a thousand of them: mixed units are more often the reason than such a model."
    ["a density, a specific heat or a conductivity in other units than lengths and times are", "a duration in another unit"]
    ["units that go together: docs/howto/units.md", "where it is meant so, nothing"]

    NOT_CONVERGED "S0501" Convergence "an increment did not converge"
    "The equations of an increment could not be solved, with increments down to the smallest one allowed. All increments \
     before it are saved."
    ["the load is more than the structure bears", "contact status changes back and forth", "the mesh is too coarse at the contact",
     "a penalty or spring that is far stiffer than the bodies"]
    ["what the message proposes, for the contact or element that it names", "prescribe a motion instead of a load",
     "another method of that contact", "finer mesh, or smoother surfaces"]

    BY_POINTS "S0502" Convergence "a case that is solved again by Gauss points"
    "An increment could not be solved with mortar contact, which the program had chosen. Gauss points with a penalty pass over \
     edges and corners that mortar does not, so the whole case is solved again with them. Forces are as right, pressures less even."
    ["a sharp edge that slides off the other side, as in a snap-fit", "an edge that is pressed into the other side"]
    ["nothing, where the second solution is of use", "to start with it:  method = \"gauss-point\"  of the contact",
     "to do without it:  on_trouble = [\"cut\", \"stabilize\"]"]

    MODES_NOT_FOUND "S0503" Convergence "natural modes that did not converge"
    "The natural modes that a step asks for were not all found: the residuals of some stayed too large. frequencies.csv has them \
     with their residuals, and says in the column `converged` which are solutions."
    ["stiffnesses that differ by many powers of ten", "far more modes than the mesh resolves"]
    ["fewer `modes`", "a range of frequencies:  frequency = { lower = …, upper = … }"]

    NOT_WRITTEN "S0601" Output "results could not be written"
    "Writing a file failed. Frames and checkpoints that were complete before are untouched."
    ["the disk is full", "no permission", "a network drive went away"]
    ["free space or name another directory with -o", "go on with  signorini resume DIR"]

    OTHER_RESULTS "S0602" Input "the output folder holds something else"
    "The folder for the results holds the results of another case, or files that no run has written. A run never \
     writes over what it does not know."
    ["two cases have the same name", "-o names a folder of other files"]
    ["name another folder with -o DIR", "write there all the same: --fresh"]

    CANNOT_RESUME "S0701" Restart "the run cannot go on"
    "There is no checkpoint that this run could go on from. A checkpoint belongs to one case, one mesh and one format; \
     another one would give wrong numbers."
    ["the case or the mesh was changed", "the files were damaged or removed", "another version of the program wrote them"]
    ["undo the change", "start again: signorini run CASE --fresh"]

    LIMIT_REACHED "S0801" Limit "a limit was reached"
    "The run stopped because it reached a limit that was set for it. What had converged is on disk."
    ["the time given with --max-wall is over"]
    ["go on with  signorini resume DIR", "give more time"]

    OUT_OF_MEMORY "S0802" Limit "out of memory"
    "The machine, or a limit of the shell, gave no more memory. What had converged up to the last checkpoint is on disk."
    ["a model that is too large for the machine", "a limit of the shell (ulimit -v) or of a container"]
    ["go on with  signorini resume DIR  on a larger machine", "fewer unknowns, or linear elements", "linear = \"multigrid\""]

    RANKS_PARTED "S0901" Internal "the processes of a run have parted"
    "All processes that `mpirun` has started solve the same model, and compare what they have after every increment. One of them \
     has failed, or has something else than the first one; all of them end. What had converged up to the last checkpoint is on disk. \
     The exit code is that of the process that has failed, else 70."
    ["a process has no memory left, or cannot read the case or the mesh", "other files, or another program, on one of the machines",
     "processors that round differently", "a mistake of the program"]
    ["what the process says that the message names", "the same program and the same files on all machines, of one kind",
     "go on with  signorini resume DIR"]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_explained_once_and_in_order() {
        for pair in ALL.windows(2) {
            assert!(
                pair[0].id < pair[1].id,
                "{} before {}",
                pair[0].id,
                pair[1].id
            );
        }
        for code in ALL {
            assert_eq!(code.id.len(), 5);
            assert!(code.id.starts_with('S') && code.id[1..].bytes().all(|b| b.is_ascii_digit()));
            assert!(
                !code.title.ends_with('.') && !code.title.is_empty(),
                "{}",
                code.id
            );
            assert!(code.meaning.ends_with('.'), "{}", code.id);
            assert!(
                !code.reasons.is_empty() && !code.remedies.is_empty(),
                "{}",
                code.id
            );
        }
    }

    #[test]
    fn every_code_is_of_a_class_that_its_number_allows() {
        for code in ALL {
            let allowed: &[Class] = match &code.id[..3] {
                "S01" => &[Class::Input],
                "S02" => &[Class::Input, Class::Model],
                "S03" => &[Class::Model],
                "S04" => continue,
                "S05" => &[Class::Convergence],
                "S06" => &[Class::Output, Class::Input],
                "S07" => &[Class::Restart],
                "S08" => &[Class::Limit],
                "S09" => &[Class::Internal],
                _ => &[],
            };
            assert!(allowed.contains(&code.class), "{}", code.id);
        }
    }

    #[test]
    fn every_code_in_a_string_of_this_crate_exists() {
        fn visit(folder: &std::path::Path, seen: &mut usize) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    visit(&path, seen);
                } else if path.extension().is_some_and(|end| end == "rs") {
                    let text = std::fs::read_to_string(&path).unwrap();
                    for (at, _) in text.match_indices("S0") {
                        let id = text.get(at..at + 5).unwrap_or_default();
                        if id.len() == 5 && id[1..].bytes().all(|b| b.is_ascii_digit()) {
                            assert!(Code::find(id).is_some(), "{id} in {}", path.display());
                            *seen += 1;
                        }
                    }
                }
            }
        }
        let mut seen = 0;
        visit(
            &std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
            &mut seen,
        );
        assert!(seen >= ALL.len());
    }

    #[test]
    fn an_explanation_says_what_why_and_what_to_do() {
        let text = Code::find("s0102").unwrap().explanation();
        assert!(text.starts_with("S0102: unknown key\n\n"));
        assert!(text.contains("\nPossible reasons\n  * a typing error\n"));
        assert!(text.contains("\nWhat to do\n"));
        assert!(Code::find("S9999").is_none());
    }
}
