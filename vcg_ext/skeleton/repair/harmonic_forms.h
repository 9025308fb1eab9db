// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Quadratic and cubic forms in space, and their harmonic parts: moments of the expansion of
/// a potential.

#ifndef VCG_MCF_HARMONIC_FORMS_H
#define VCG_MCF_HARMONIC_FORMS_H

#include <vcg/space/point3.h>

#include <array>
#include <cstddef>

namespace vcg::tri::mcf::detail {

/// Coefficients of x^2, y^2, z^2, xy, xz, yz.
using QuadraticForm = std::array<double, 6>;
/// Coefficients of x^3, y^3, z^3, x^2 y, x^2 z, y^2 x, y^2 z, z^2 x, z^2 y, xyz.
using CubicForm = std::array<double, 10>;

/// (a . r) (b . r)
inline QuadraticForm product(const Point3d& a, const Point3d& b)
{
	return {a[0] * b[0], a[1] * b[1], a[2] * b[2], a[0] * b[1] + a[1] * b[0],
		a[0] * b[2] + a[2] * b[0], a[1] * b[2] + a[2] * b[1]};
}

/// q(r) (b . r)
inline CubicForm product(const QuadraticForm& q, const Point3d& b)
{
	return {q[0] * b[0], q[1] * b[1], q[2] * b[2], q[0] * b[1] + q[3] * b[0],
		q[0] * b[2] + q[4] * b[0], q[1] * b[0] + q[3] * b[1], q[1] * b[2] + q[5] * b[1],
		q[2] * b[0] + q[4] * b[2], q[2] * b[1] + q[5] * b[2],
		q[3] * b[2] + q[4] * b[1] + q[5] * b[0]};
}

template <class Form>
void addTo(Form& sum, const Form& form, double factor)
{
	for (size_t i = 0; i < sum.size(); ++i)
		sum[i] += factor * form[i];
}

inline double valueAt(const QuadraticForm& q, const Point3d& r)
{
	return r[0] * (q[0] * r[0] + q[3] * r[1] + q[4] * r[2]) + r[1] * (q[1] * r[1] + q[5] * r[2])
		+ r[2] * q[2] * r[2];
}

inline double valueAt(const CubicForm& c, const Point3d& r)
{
	const double x = r[0] * r[0], y = r[1] * r[1], z = r[2] * r[2];
	return x * (c[0] * r[0] + c[3] * r[1] + c[4] * r[2])
		+ y * (c[1] * r[1] + c[5] * r[0] + c[6] * r[2])
		+ z * (c[2] * r[2] + c[7] * r[0] + c[8] * r[1]) + c[9] * r[0] * r[1] * r[2];
}

/// Subtracts the multiple of |r|^2 that leaves a harmonic form.
inline void makeHarmonic(QuadraticForm& q)
{
	const double trace = q[0] + q[1] + q[2];
	for (size_t i = 0; i < 3; ++i)
		q[i] -= trace / 3;
}

inline void makeHarmonic(CubicForm& c)
{
	const double x = (3 * c[0] + c[5] + c[7]) / 5, y = (3 * c[1] + c[3] + c[8]) / 5,
				 z = (3 * c[2] + c[4] + c[6]) / 5;
	addTo(c, {x, y, z, y, z, x, z, x, y, 0}, -1);
}

} // namespace vcg::tri::mcf::detail

#endif
