// SPDX-License-Identifier: MIT OR Apache-2.0

//! Curves of any degree, polynomial or rational, with any number of pieces between two points.
//!
//! The criteria are the same as for cubics. With a curve `A/w` in homogeneous form, `w > 0`,
//!
//! - `γ' = (A'w − Aw')/w²`,
//! - `γ'×γ'' = (w A'×A'' − w' A×A'' + w'' A×A')/w³`,
//! - `det[γ', γ'', γ'''] = (w[A'A''A'''] − w'[AA''A'''] + w''[AA'A'''] − w'''[AA'A''])/w⁴`,
//!
//! so every sign question is one on a polynomial, decided by certified subdivision of its Bernstein
//! form ([`shapespline_geometry::polynomial`]); what rounding leaves open is reported as undecided.

mod checker;
mod corner;
mod cubics;
mod error;
mod margin;
mod pieces;
mod prove_sign;
mod question;
mod segment;
mod single_pieces;
mod single_sign_change;
mod turning;

pub use checker::{CurveChecker, INTERPOLATION, check_curve};
pub use error::CurveError;
pub(crate) use margin::{margin, minimum};
pub(crate) use prove_sign::{is_never_outside, prove_sign};
pub(crate) use question::Question;
pub(crate) use segment::{Piece, Segment, corners};
