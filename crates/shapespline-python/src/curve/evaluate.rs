// SPDX-License-Identifier: MIT OR Apache-2.0

//! Position, derivatives, curvature, torsion and frame at any parameters.

use pyo3::{IntoPyObjectExt, prelude::*};
use shapespline::{
    geometry::{DVec3, Side},
    polynomial::parallel,
};

use super::{Curve, SpaceCurve};
use crate::{
    error::input_error,
    input::Query,
    options,
    output::{FloatArray, filled, shaped, vector},
    work::{PARALLEL, interruptible, parts},
};

impl SpaceCurve {
    /// `COLUMNS` numbers for each parameter, computed from the curve: an array of a shape.
    fn rows<'py, const COLUMNS: usize>(
        &self,
        py: Python<'py>,
        u: &[f64],
        shape: &[usize],
        of: impl Fn(&dyn Curve, f64) -> [f64; COLUMNS] + Send + Sync,
    ) -> PyResult<FloatArray<'py>> {
        let curve: &dyn Curve = &**self.curve;
        filled(py, shape, |out| {
            let rows = out.as_chunks_mut().0;
            interruptible(py, u.len(), |go_on| {
                for part in parts(u.len()).take_while(|_| go_on().is_continue()) {
                    let (rows, u) = (&mut rows[part.clone()], &u[part]);
                    let row = |i: usize, row: &mut [f64; COLUMNS]| *row = of(curve, u[i]);
                    parallel::fill(rows, PARALLEL, row);
                }
            })
        })
    }

    /// A number for each parameter: a float for one, an array of the query's shape for many.
    pub(crate) fn scalar<'py>(
        &self,
        py: Python<'py>,
        u: &Query<'py>,
        of: impl Fn(&dyn Curve, f64) -> f64 + Send + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        match u {
            Query::One(u) => of(&**self.curve, *u).into_bound_py_any(py),
            Query::Many(u) => {
                let of = |curve: &dyn Curve, u| [of(curve, u)];
                Ok(self.rows(py, u.values(), u.shape(), of)?.into_any())
            }
        }
    }

    /// A vector with as many components as asked for each parameter.
    fn vectors<'py>(
        &self,
        py: Python<'py>,
        u: &Query<'py>,
        columns: usize,
        of: impl Fn(&dyn Curve, f64) -> DVec3 + Send + Sync,
    ) -> PyResult<FloatArray<'py>> {
        match u {
            Query::One(u) => Ok(vector(py, of(&**self.curve, *u), columns)),
            Query::Many(u) => {
                let (values, shape) = (u.values(), with_columns(u.shape(), columns));
                if columns == 2 {
                    self.rows(py, values, &shape, |curve, u| of(curve, u).truncate().to_array())
                } else {
                    self.rows(py, values, &shape, |curve, u| of(curve, u).to_array())
                }
            }
        }
    }
}

fn with_columns(shape: &[usize], columns: usize) -> Vec<usize> {
    shape.iter().copied().chain([columns]).collect()
}

#[pymethods]
impl SpaceCurve {
    /// Evaluate the curve or a derivative.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape. Outside the parameters of the points the end polynomials go on;
    ///     on a closed curve the parameter wraps around. NaN gives NaN.
    /// nu : int
    ///     Order of the derivative with respect to u; 0 gives positions. (The ν of ν-splines is
    ///     called ``tension``.)
    /// side : {"right", "left"}
    ///     Which segment counts at the parameter of a point, where derivatives may jump.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (*u.shape, dim)
    ///     In units of the points over units of the parameter to the power ``nu``.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If ``nu`` is negative (of a `TensionSpline`, or above 3) or ``side`` unknown.
    /// TypeError
    ///     If ``u`` does not hold real numbers.
    ///
    /// Notes
    /// -----
    /// Cost O(log n) for one parameter, O(1) each for many; many run on all threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
    /// >>> curve(2.5)
    /// array([1.5, 2. ])
    /// >>> curve([[0, 5], [10, 15]], 1).shape
    /// (2, 2, 2)
    #[pyo3(
        signature = (u, nu=0, *, side=Side::Right),
        text_signature = "($self, u, nu=0, *, side='right')"
    )]
    fn _call<'py>(
        &self,
        py: Python<'py>,
        u: Query<'py>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
        #[pyo3(from_py_with = options::side)] side: Side,
    ) -> PyResult<FloatArray<'py>> {
        // From the fourth derivative on all are zero, or refused.
        let order = nu.min(4);
        let columns = self.columns();
        match u {
            // The fourth, which not every curve has, is left to what can say so.
            Query::One(u) if order < 4 => {
                Ok(vector(py, self.curve.path().evaluate(u, order, side), columns))
            }
            Query::One(u) => {
                let path = self.curve.path();
                let value = path.evaluate_many(&[u], order, side).map_err(input_error)?;
                shaped(py, value, &[columns])
            }
            Query::Many(u) => {
                let (parameters, path) = (u.values(), self.curve.path());
                filled(py, &with_columns(u.shape(), columns), |out| {
                    let done = interruptible(py, parameters.len(), |go_on| {
                        parts(parameters.len()).take_while(|_| go_on().is_continue()).try_for_each(
                            |part| {
                                let out = &mut out[part.start * columns..part.end * columns];
                                path.evaluate_into(&parameters[part], order, side, out)
                            },
                        )
                    });
                    done?.map_err(input_error)
                })
            }
        }
    }

    /// Curvature κ = ‖γ′ × γ″‖ / ‖γ′‖³, in reciprocal units of the points.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape.
    /// side : {"right", "left"}
    ///     Which segment counts at the parameter of a point. (κ of a ν-spline or a
    ///     C² tension cubic does not jump.)
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray, shape u.shape
    ///     Never negative, in the plane as well; NaN where γ′ = 0.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> import shapespline as ss
    /// >>> angle = np.linspace(0, 2 * np.pi, 101)
    /// >>> circle = 2 * np.column_stack([np.cos(angle), np.sin(angle)])
    /// >>> circle[-1] = circle[0]
    /// >>> round(ss.NuSpline(circle, boundary="periodic").curvature(1.0), 3)
    /// 0.5
    #[pyo3(signature = (u, *, side=Side::Right), text_signature = "($self, u, *, side='right')")]
    fn curvature<'py>(
        &self,
        py: Python<'py>,
        u: Query<'py>,
        #[pyo3(from_py_with = options::side)] side: Side,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.scalar(py, &u, move |curve, u| curve.path().curvature(u, side))
    }

    /// Curvature vector dT/ds: curvature times principal normal, in reciprocal units of the points.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape.
    /// side : {"right", "left"}
    ///     Which segment counts at the parameter of a point.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (*u.shape, dim)
    ///     Zero on a line; NaN where γ′ = 0.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4], [6, 8]]).curvature_vector(1.0).shape
    /// (2,)
    #[pyo3(signature = (u, *, side=Side::Right), text_signature = "($self, u, *, side='right')")]
    fn curvature_vector<'py>(
        &self,
        py: Python<'py>,
        u: Query<'py>,
        #[pyo3(from_py_with = options::side)] side: Side,
    ) -> PyResult<FloatArray<'py>> {
        self.vectors(py, &u, self.columns(), move |curve, u| curve.path().curvature_vector(u, side))
    }

    /// Torsion τ = det[γ′, γ″, γ‴] / ‖γ′ × γ″‖², in reciprocal units of the points.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape.
    /// side : {"right", "left"}
    ///     Which segment counts at the parameter of a point, where torsion jumps.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray, shape u.shape
    ///     Positive where the curve twists like a right-handed screw; zero in the plane; NaN where the
    ///     curvature vanishes.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> import shapespline as ss
    /// >>> t = np.linspace(0, 6, 601)
    /// >>> helix = np.column_stack([np.cos(t), np.sin(t), t])
    /// >>> round(ss.NuSpline(helix, boundary="circular").torsion(4.001), 2)
    /// 0.5
    #[pyo3(signature = (u, *, side=Side::Right), text_signature = "($self, u, *, side='right')")]
    fn torsion<'py>(
        &self,
        py: Python<'py>,
        u: Query<'py>,
        #[pyo3(from_py_with = options::side)] side: Side,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.scalar(py, &u, move |curve, u| curve.path().torsion(u, side))
    }

    /// Return the Frenet frame: unit tangent T, principal normal N and binormal B = T × N.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape.
    /// side : {"right", "left"}
    ///     Which segment counts at the parameter of a point.
    ///
    /// Returns
    /// -------
    /// T, N, B : numpy.ndarray, shape (*u.shape, 3)
    ///     Three components also for curves in the plane, whose B is (0, 0, ±1). N and B are NaN where
    ///     the curvature vanishes.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> T, N, B = ss.NuSpline([[0, 0], [1, 1], [2, 0]]).frame(0.5)
    /// >>> B
    /// array([ 0.,  0., -1.])
    #[pyo3(signature = (u, side=Side::Right), text_signature = "($self, u, side='right')")]
    #[allow(clippy::type_complexity)]
    fn frame<'py>(
        &self,
        py: Python<'py>,
        u: Query<'py>,
        #[pyo3(from_py_with = options::side)] side: Side,
    ) -> PyResult<(FloatArray<'py>, FloatArray<'py>, FloatArray<'py>)> {
        let frame = move |curve: &dyn Curve, u: f64| curve.path().frame(u, side);
        Ok((
            self.vectors(py, &u, 3, move |curve, u| frame(curve, u).tangent)?,
            self.vectors(py, &u, 3, move |curve, u| frame(curve, u).normal)?,
            self.vectors(py, &u, 3, move |curve, u| frame(curve, u).binormal)?,
        ))
    }
}
