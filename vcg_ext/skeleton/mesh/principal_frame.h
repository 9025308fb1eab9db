// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Coordinates that belong to a shape: they turn, move and grow with it.

#ifndef VCG_MCF_PRINCIPAL_FRAME_H
#define VCG_MCF_PRINCIPAL_FRAME_H

#include "surface_mesh.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The principal axes of a surface, or of points, with their centroid as the origin.
 *
 * The axes are the eigenvectors of the second moments S = int (x - m)(x - m)^T dA, m the centroid,
 * by falling eigenvalue. An axis points to where the third moment int (u . (x - m))^3 dA is
 * positive, or where that is 0, the sum of the cubes over the centroids of the triangles. So a
 * mirrored shape has the mirrored axes, which may be left-handed: see isMirrored(). Axes along which
 * the shape is symmetric point the way of the nearest coordinate axis, but for the last of them,
 * which makes the axes right-handed: harmless, since all choices are alike. Where two eigenvalues
 * are equal (a sphere, a cube, a torus), the axes are those of the coordinates, which point to
 * where the third moment is positive.
 *
 * The size is the diagonal of the bounding box along these axes. Unlike that of the axis-aligned
 * box, which changes by up to a factor of sqrt 3, it stays the same when the shape is turned; for
 * an axis-aligned box both are equal. The unit is sqrt(12 tr S / A), which is the size of a rod and
 * of a sphere; unlike the size it does not depend on single points.
 *
 * The integrals do not depend on the triangulation; the signs do, where the surface is symmetric.
 */
class PrincipalFrame
{
public:
	/// The frame of the coordinates themselves.
	PrincipalFrame() = default;

	/**
	 * The frames of the components of a surface.
	 * @param component of each vertex slot, see connectedComponents().
	 * @pre the positions are finite. @throws Cancelled. Complexity: O(V + F).
	 */
	static std::vector<PrincipalFrame> ofComponents(const SurfaceMesh& mesh,
		const std::vector<int>& component, size_t components, const Progress& progress = Progress())
	{
		const auto forEachPoint = [&](const Progress& part, auto&& visit) {
			detail::reportedLoop(mesh.vertexSlots(), part, what, [&](int v) {
				if (mesh.isVertex(v))
					visit(size_t(component[v]), mesh.position[v]);
			});
		};
		const auto forEachCell = [&](const Progress& part, auto&& visit) {
			detail::reportedLoop(mesh.faceSlots(), part, what, [&](int f) {
				if (!mesh.isFace(f))
					return;
				const Triangle t = mesh.triangle(f);
				visit(size_t(component[t[0]]),
					std::array<Point3d, 3> {
						mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]},
					mesh.doubleAreaVector(f).Norm() / 2);
			});
		};
		return made(components, forEachPoint, forEachCell, progress);
	}

	/// The frames of sets of points of equal weight; `component` is the set of each point.
	/// @throws Cancelled. Complexity: O(V).
	static std::vector<PrincipalFrame> ofPoints(const std::vector<Point3d>& points,
		const std::vector<int>& component, size_t components, const Progress& progress = Progress())
	{
		const auto forEachPoint = [&](const Progress& part, auto&& visit) {
			detail::reportedLoop(int(points.size()), part, what,
				[&](int i) { visit(size_t(component[i]), points[i]); });
		};
		const auto forEachCell = [&](const Progress& part, auto&& visit) {
			forEachPoint(part,
				[&](size_t c, const Point3d& p) { visit(c, std::array<Point3d, 1> {p}, 1.0); });
		};
		return made(components, forEachPoint, forEachCell, progress);
	}

	/// Area of the surface that the frame is of, mesh units squared; of points, their number.
	double area() const { return weight; }
	/// Diagonal of the bounding box along the axes, mesh units.
	double size() const { return diagonal; }
	/// size() in the coordinates of the frame, rounded: the same bits for all copies of a shape.
	double sizeInside() const { return rounded(diagonal / unit, 40); }
	/// Whether the axes are left-handed: in the frame, the shape is its mirror image, and faces
	/// have to be turned over to face outwards, see turnOverMirrored().
	bool isMirrored() const { return (axes[0] ^ axes[1]) * axes[2] < 0; }
	/// The unit of the coordinates of the frame, mesh units.
	double unitLength() const { return unit; }
	/// The coordinates of a point in the frame; out() is the inverse.
	Point3d in(const Point3d& p) const { return turned(p - origin) / unit; }
	Point3d out(const Point3d& p) const
	{
		return origin + (axes[0] * p[0] + axes[1] * p[1] + axes[2] * p[2]) * unit;
	}

	/**
	 * As in(), rounded: the same bits for all copies of a shape that differ by rounding.
	 *
	 * The grid has steps of 2^-22, about what single precision resolves. Values within a step are
	 * divided at its golden section: far from all simple fractions, where means of points that were
	 * rounded before would be thrown to either side.
	 */
	Point3d onGrid(const Point3d& p) const { return rounded(in(p)); }

	/// A point, mesh units, moved to its place on the grid: out(onGrid(p)).
	Point3d snapped(const Point3d& p) const { return out(onGrid(p)); }

	/// Rounds a point that is given in the coordinates of the frame, as onGrid() does.
	static Point3d rounded(Point3d p)
	{
		for (int k = 0; k < 3; ++k)
			p[k] = rounded(p[k], 22);
		return p;
	}

	/// A length, mesh units, in the unit of the frame, rounded likewise to 2^-40.
	double lengthOnGrid(double length) const { return rounded(length / unit, 40); }

private:
	using Axes = std::array<Point3d, 3>;

	static constexpr const char* what = "Measuring the surface";

	static double rounded(double x, int binaryDigits)
	{
		constexpr double goldenPart = 0.6180339887498949; // (sqrt 5 - 1) / 2
		const double steps = double(std::int64_t(1) << binaryDigits);
		const double y = x * steps + goldenPart;
		// std::floor() is a function call where the target may lack an instruction for it.
		constexpr double noFraction = double(std::int64_t(1) << 52);
		if (!(std::abs(y) < noFraction))
			return y / steps;
		const double towardsZero = double(std::int64_t(y));
		return (towardsZero - double(towardsZero > y)) / steps;
	}

	/// Integrals about the origin of a frame, in its unit; weights are mesh units^2, or points.
	struct Moments
	{
		double weight = 0;
		Point3d first = Point3d(0, 0, 0);
		Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
		std::array<double, 3> third = {0, 0, 0}; ///< along the axes
		/// The same for the cells' centroids, each of weight 1: depends on the triangulation.
		std::array<double, 3> thirdOfMiddles = {0, 0, 0};
		double cells = 0;

		/// Adds all but the third moments of a cell, a point or a triangle:
		///     int x dA = A s / n,  int x x^T dA = A (s s^T + sum_i x_i x_i^T) / (n (n + 1)),
		/// s the sum of its n corners x_i.
		template <size_t n>
		void add(const std::array<Point3d, n>& corners, double area)
		{
			Point3d s(0, 0, 0);
			double sum[6] = {};
			const auto addSquare = [&](const Point3d& x) {
				for (int k = 0; k < 3; ++k) {
					sum[k] += x[k] * x[k];
					sum[3 + k] += x[k] * x[(k + 1) % 3];
				}
			};
			for (const Point3d& x : corners) {
				s += x;
				addSquare(x);
			}
			addSquare(s);
			weight += area;
			first += s * (area / n);
			for (int k = 0; k < 3; ++k) {
				const int l = (k + 1) % 3;
				second(k, k) += sum[k] * (area / (n * (n + 1)));
				second(k, l) += sum[3 + k] * (area / (n * (n + 1)));
				second(l, k) = second(k, l);
			}
		}

		/// Mean of u^3 over a point, or over a triangle at whose corners u has these values: the
		/// mean of all ten products of three of them.
		static double meanCube(const std::array<double, 1>& u) { return u[0] * u[0] * u[0]; }
		static double meanCube(const std::array<double, 3>& u)
		{
			const double sum = u[0] + u[1] + u[2];
			const double pairs = u[0] * u[1] + u[1] * u[2] + u[2] * u[0];
			return (sum * (sum * sum - 2 * pairs) + u[0] * u[1] * u[2]) / 10;
		}

		/// The second moments about the centroid, by weight.
		Eigen::Matrix3d spread() const
		{
			const Eigen::Vector3d m(first[0] / weight, first[1] / weight, first[2] / weight);
			return second / weight - m * m.transpose();
		}
		/// The new unit of the frame, in the unit of the moments.
		double extent() const
		{
			const double squared = weight > 0 ? 12 * spread().trace() : 0;
			return squared > 0 ? std::sqrt(squared) : 1;
		}
	};

	Point3d origin = Point3d(0, 0, 0);
	Axes axes = coordinateAxes();
	bool isAligned = false; ///< the axes are those of the moments, not the coordinate axes for want
							///< of different eigenvalues
	double unit = 1, diagonal = 1, weight = 0;

	static Axes coordinateAxes() { return {Point3d(1, 0, 0), Point3d(0, 1, 0), Point3d(0, 0, 1)}; }

	Point3d turned(const Point3d& p) const
	{
		return Point3d(axes[0] * p, axes[1] * p, axes[2] * p);
	}

	/**
	 * @param forEachPoint (progress, visit) calls visit(component, point) for all points that the
	 *                     box must hold.
	 * @param forEachCell  (progress, visit) calls visit(component, corners, area) for all cells of
	 *                     the integrals.
	 */
	template <class ForEachPoint, class ForEachCell>
	static std::vector<PrincipalFrame> made(size_t components, ForEachPoint&& forEachPoint,
		ForEachCell&& forEachCell, const Progress& progress)
	{
		std::vector<PrincipalFrame> frame(components);
		std::vector<Moments> moments(components);
		// Moments are taken near the middle: far from the origin, they would lose all digits.
		std::vector<Box3d> box(components);
		forEachPoint(progress.part(0, 0.1), [&](size_t c, const Point3d& p) { box[c].Add(p); });
		for (size_t c = 0; c < components; ++c)
			if (!box[c].IsNull()) {
				frame[c].origin = box[c].Center();
				if (box[c].Diag() > 0)
					frame[c].unit = frame[c].diagonal = box[c].Diag();
			}
		forEachCell(progress.part(0.1, 0.5), [&](size_t c, auto corners, double area) {
			const double scale = 1 / frame[c].unit;
			for (Point3d& p : corners)
				p = (p - frame[c].origin) * scale;
			moments[c].add(corners, area);
		});
		for (size_t c = 0; c < components; ++c)
			frame[c].align(moments[c]);
		forEachCell(progress.part(0.5, 0.9), [&](size_t c, const auto& corners, double area) {
			const double scale = 1 / frame[c].unit;
			for (int k = 0; k < 3; ++k) {
				std::array<double, std::tuple_size_v<std::decay_t<decltype(corners)>>> u;
				for (size_t i = 0; i < u.size(); ++i)
					u[i] = (corners[i] - frame[c].origin) * frame[c].axes[k] * scale;
				moments[c].third[k] += area * Moments::meanCube(u);
				double middle = 0;
				for (double x : u)
					middle += x / double(u.size());
				moments[c].thirdOfMiddles[k] += middle * middle * middle;
			}
			++moments[c].cells;
		});
		std::vector<Box3d> along(components);
		for (size_t c = 0; c < components; ++c)
			frame[c].orient(moments[c]);
		forEachPoint(progress.part(0.9, 1), [&](size_t c, const Point3d& p) {
			along[c].Add(frame[c].turned(p - frame[c].origin));
		});
		for (size_t c = 0; c < components; ++c) {
			if (!along[c].IsNull() && along[c].Diag() > 0)
				frame[c].diagonal = along[c].Diag();
			frame[c].unit *= moments[c].extent();
			frame[c].weight = moments[c].weight;
		}
		return frame;
	}

	/// Moves the origin to the centroid and turns the axes, where they can be told apart.
	void align(const Moments& m)
	{
		constexpr double minGap = 1e-6; // of the sum of the eigenvalues
		if (!(m.weight > 0))
			return;
		origin += m.first * (unit / m.weight);
		const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m.spread());
		const Eigen::Vector3d& value = solver.eigenvalues();
		const double gap = minGap * value.sum();
		if (!(value[1] - value[0] > gap && value[2] - value[1] > gap))
			return;
		isAligned = true;
		for (int k = 0; k < 3; ++k)
			for (int i = 0; i < 3; ++i)
				axes[k][i] = solver.eigenvectors()(i, 2 - k);
	}

	/// Chooses the signs of the axes.
	void orient(const Moments& m)
	{
		constexpr double minSkew = 1e-6, minSkewOfMiddles = 1e-8;
		int symmetric = -1;
		for (int k = 0; k < 3; ++k) {
			double towards = m.third[k];
			if (std::abs(towards) <= minSkew * m.weight) {
				if (!isAligned)
					continue;
				towards = m.thirdOfMiddles[k];
				if (std::abs(towards) <= minSkewOfMiddles * m.cells) {
					symmetric = k;
					towards = axes[k][0];
					for (int i = 1; i < 3; ++i)
						if (std::abs(axes[k][i]) > std::abs(towards))
							towards = axes[k][i];
				}
			}
			if (towards < 0)
				axes[k] *= -1;
		}
		if (symmetric >= 0 && isMirrored())
			axes[symmetric] *= -1;
	}
};

/**
 * Turns over the faces of the components whose frames are mirrored, so that they face outwards in
 * these frames. Applied twice, it restores the mesh.
 * @param component of each vertex.
 * @throws Cancelled. Complexity: O(V + F), without such frames O(components).
 */
inline void turnOverMirrored(SurfaceMesh& mesh, const std::vector<int>& component,
	const std::vector<PrincipalFrame>& frames, const Cancellation& cancel = Cancellation())
{
	std::vector<char> isMirrored;
	for (const PrincipalFrame& frame : frames)
		isMirrored.push_back(frame.isMirrored());
	if (std::find(isMirrored.begin(), isMirrored.end(), 1) != isMirrored.end())
		mesh.turnOver([&](int v) { return isMirrored[component[v]] != 0; }, cancel);
}

} // namespace vcg::tri::mcf

#endif
