//! placeholder
pub mod block_tridiagonal;
pub mod box_qp;
