//! What a ball touches: surfaces with their normals, and how fast it leaves them.

use carom_geometry::site::Site;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// More contacts than this at one instant never change the answer: three normals carry any load.
pub const MAX_CONTACTS: usize = 8;

/// A touched surface. The clearance there is 0 by definition, not by measurement, and `rate` is its rate of change: what an
/// impact made of it is known exactly, and is not computed again from rounded positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Index of the surface in the plan.
    pub surface: usize,
    /// What of a mesh is touched; none for a plane.
    pub site: Option<Site>,
    /// Unit normal from the surface to the ball.
    pub normal: Vector3<f64>,
    /// n.v in m/s: negative closing, positive separating, 0 in lasting contact.
    pub rate: f64,
    /// Whether the ball stays in contact and moves along it.
    pub lasting: bool,
}

/// Something for each contact of one instant: of one contact, which is the rule, it is moved in a few instructions, and of two it asks for no
/// memory.
pub type PerContact<T> = SmallVec<[T; 2]>;

/// The contacts of one instant, [`MAX_CONTACTS`] at most, in an order that does not depend on the order of the surfaces.
pub type Contacts = PerContact<Contact>;
