// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/repair/harmonic_forms.h>

#include <gtest/gtest.h>

using namespace vcg::tri::mcf;
using vcg::Point3d;

TEST(HarmonicForms, AreProductsOfLinearOnesAndMadeHarmonic)
{
	const Point3d a(0.3, -1.2, 0.7), b(1.1, 0.4, -0.9), c(-0.2, 0.8, 1.7);
	detail::QuadraticForm quadratic = detail::product(a, b);
	detail::CubicForm cubic = detail::product(quadratic, c);
	const Point3d r(0.9, 1.3, -0.6);
	EXPECT_NEAR(detail::valueAt(quadratic, r), (a * r) * (b * r), 1e-14);
	EXPECT_NEAR(detail::valueAt(cubic, r), (a * r) * (b * r) * (c * r), 1e-14);
	detail::makeHarmonic(quadratic);
	detail::makeHarmonic(cubic);
	// Of a polynomial of the third degree, second differences are exact.
	const auto laplacian = [&](const auto& form) {
		double sum = 0;
		for (int k = 0; k < 3; ++k) {
			Point3d step(0, 0, 0);
			step[k] = 0.5;
			sum += detail::valueAt(form, r + step) + detail::valueAt(form, r - step)
				- 2 * detail::valueAt(form, r);
		}
		return sum;
	};
	EXPECT_NEAR(laplacian(quadratic), 0, 1e-13);
	EXPECT_NEAR(laplacian(cubic), 0, 1e-13);
}
