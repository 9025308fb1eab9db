// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/spatial/four_values.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace vcg::tri::mcf;

TEST(FourValues, ThoseWithinTheLimitAreWrittenLastFirst)
{
	constexpr float infinity = std::numeric_limits<float>::infinity();
	const float notANumber = std::numeric_limits<float>::quiet_NaN();
	const float limit = 0.25f;
	for (const float within : {limit, 0.f, -1.f, -infinity})
		for (const float beyond : {std::nextafter(limit, 1.f), infinity, notANumber})
			for (int mask = 0; mask < 16; ++mask) {
				Eigen::Array4f values;
				std::vector<int> expected;
				for (int k = 0; k < 4; ++k) {
					const bool isWithin = (mask >> k & 1) != 0;
					values[k] = isWithin ? within : beyond;
					if (isWithin)
						expected.insert(expected.begin(), 1000 + k);
				}
				int written[4];
				const int count = writeWithin(values, limit, 1000, written);
				EXPECT_EQ(std::vector<int>(written, written + count), expected);
			}
}
