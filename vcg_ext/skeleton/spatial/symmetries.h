// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The reflections and rotations that map a surface to itself, nearly.

#ifndef VCG_MCF_SYMMETRIES_H
#define VCG_MCF_SYMMETRIES_H

#include "closest_surface.h"

#include <skeleton/core/point_hash.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Calls visit(a, b, c) with the corners of each triangle of some components. @throws Cancelled
template <class Visitor>
void forEachTriangleOf(const SurfaceMesh& mesh, const std::vector<int>& vertices,
	const Cancellation& cancel, Visitor&& visit)
{
	cancellableLoop(int(vertices.size()), cancel, [&](int i) {
		mesh.forEachOwnFace(vertices[size_t(i)], [&](int f) {
			const Triangle t = mesh.triangle(f);
			visit(mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]);
		});
	});
}

inline Point3d toPoint(const Eigen::Vector3d& v)
{
	return {v[0], v[1], v[2]};
}
inline Eigen::Vector3d toEigen(const Point3d& p)
{
	return {p[0], p[1], p[2]};
}

inline Point3d mapped(const Eigen::Isometry3d& map, const Point3d& p)
{
	return toPoint(map * toEigen(p));
}

/// A map on a grid far below its precision: in whichever order sums were taken, the same bits.
inline Eigen::Isometry3d rounded(Eigen::Isometry3d map)
{
	constexpr double grid = 1 << 24;
	map.matrix() = (map.matrix() * grid).array().round() / grid;
	return map;
}

/// Reflections and rotations about the centroid that a surface may be symmetric under.
class SymmetryCandidates
{
public:
	/// @throws Cancelled. Complexity: O(F).
	SymmetryCandidates(
		const SurfaceMesh& mesh, const std::vector<int>& vertices, const Cancellation& cancel)
	{
		measure(mesh, vertices, cancel);
		// The normal of a mirror plane and the axis of a rotation are eigenvectors of the second
		// moments. Where eigenvalues are alike, the eigenvectors are not known well.
		constexpr double alike = 0.1;
		const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second);
		const Eigen::Vector3d& value = solver.eigenvalues();
		const bool first = value[1] - value[0] <= alike * value[1];
		const bool last = value[2] - value[1] <= alike * value[2];
		for (int i = 0; i < 3; ++i) {
			const Eigen::Vector3d axis = solver.eigenvectors().col(i);
			addNormal(toPoint(axis));
			axes.push_back({axis, (i == 2 && first) || (i == 0 && last) ? mostTurns : 2});
			if (axes.back().turns > 2)
				addPlanesThrough(axis, mesh, vertices, cancel);
		}
		if (first || last)
			for (int i = 0; i < 3; ++i) {
				Point3d one(0, 0, 0), next(0, 0, 0);
				one[i] = next[(i + 1) % 3] = 1;
				for (Point3d normal : {one, one + next, one - next})
					addNormal(normal.Normalize());
			}
	}

	/// visit(reflection), for each candidate.
	template <class Visitor>
	void forEachReflection(Visitor&& visit) const
	{
		for (const Point3d& normal : normals) {
			const Eigen::Vector3d n = toEigen(normal);
			visit(about(Eigen::Matrix3d(Eigen::Matrix3d::Identity() - 2 * n * n.transpose())));
		}
	}

	/// holds(rotation), for the candidates around each axis by falling order until one holds: it
	/// generates the others.
	template <class Holds>
	void forEachRotation(Holds&& holds) const
	{
		for (const Axis& axis : axes)
			for (int turns = axis.turns; turns >= 2; --turns)
				if (holds(about(Eigen::AngleAxisd(2 * M_PI / turns, axis.way).toRotationMatrix())))
					break;
	}

private:
	Point3d mean = Point3d(0, 0, 0);
	Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
	static constexpr int mostTurns = 8;
	struct Axis
	{
		Eigen::Vector3d way;
		int turns; ///< maximum order of the rotations around it
	};
	std::vector<Axis> axes;
	std::vector<Point3d> normals; ///< of mirror planes, unit length

	/// The map with a linear part that keeps the centroid.
	Eigen::Isometry3d about(const Eigen::Matrix3d& linear) const
	{
		Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
		map.linear() = linear;
		map.translation() = toEigen(mean) - linear * toEigen(mean);
		return rounded(map);
	}

	/// The centroid, and the second moments S = int (x - m)(x - m)^T dA.
	void measure(
		const SurfaceMesh& mesh, const std::vector<int>& vertices, const Cancellation& cancel)
	{
		double whole = 0;
		Point3d sum(0, 0, 0);
		Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
		forEachTriangleOf(
			mesh, vertices, cancel, [&](const Point3d& a, const Point3d& b, const Point3d& c) {
				const double area = ((b - a) ^ (c - a)).Norm() / 2;
				const Point3d corners = a + b + c;
				whole += area;
				sum += corners * (area / 3);
				for (const Point3d& p : {a, b, c, corners})
					moments += toEigen(p) * toEigen(p).transpose() * (area / 12);
			});
		if (whole > 0)
			mean = sum / whole;
		second = moments - toEigen(mean) * toEigen(mean).transpose() * whole;
	}

	void addNormal(const Point3d& normal)
	{
		constexpr double same = 0.9998; // cosine of one degree
		if (std::none_of(normals.begin(), normals.end(),
				[&](const Point3d& known) { return std::abs(known * normal) > same; }))
			normals.push_back(normal);
	}

	/**
	 * Adds planes through an axis: in cylindrical coordinates around it the moments
	 *     G_n = int r^(n+2) exp(i n phi) dA
	 * of a shape that is symmetric in the plane at the angle psi have the argument n psi, modulo pi.
	 */
	void addPlanesThrough(const Eigen::Vector3d& axis, const SurfaceMesh& mesh,
		const std::vector<int>& vertices, const Cancellation& cancel)
	{
		constexpr int orders = 8;
		constexpr double minimum = 0.01; // of the moment of all that lies at one angle
		const Point3d u = toPoint(axis.unitOrthogonal()), v = toPoint(axis) ^ u;
		std::array<std::complex<double>, orders> moment = {};
		std::array<double, orders> whole = {};
		forEachTriangleOf(
			mesh, vertices, cancel, [&](const Point3d& a, const Point3d& b, const Point3d& c) {
				const Point3d p = (a + b + c) / 3 - mean;
				const std::complex<double> z(p * u, p * v);
				double size = ((b - a) ^ (c - a)).Norm() / 2 * std::norm(z);
				std::complex<double> power = size;
				for (int n = 0; n < orders; ++n) {
					power *= z;
					size *= std::abs(z);
					moment[size_t(n)] += power;
					whole[size_t(n)] += size;
				}
			});
		for (int n = 1; n <= orders; ++n) {
			const std::complex<double>& m = moment[size_t(n - 1)];
			if (!(std::abs(m) > minimum * whole[size_t(n - 1)]))
				continue;
			for (int k = 0; k < n; ++k) {
				const double angle = (std::arg(m) + k * M_PI) / n;
				addNormal(v * std::cos(angle) - u * std::sin(angle));
			}
		}
	}
};

/// Points of a surface, their images, and how far these are from the surface.
class SymmetryFit
{
public:
	SymmetryFit(const ClosestSurface& closest, std::vector<Point3d> points) :
			closest(closest), points(std::move(points))
	{
	}

	/// Whether the images of a sample of about `some` points are near the surface, on average.
	bool isNear(const Eigen::Isometry3d& map, size_t some, double near) const
	{
		double sum = 0;
		size_t count = 0;
		const size_t step = std::max<size_t>(1, points.size() / some);
		for (size_t i = 0; i < points.size(); i += step, ++count)
			sum += closest.closest(mapped(map, points[i])).distance;
		return sum <= near * double(count);
	}

	/// The map that takes the points nearest to the points of the surface that are closest to their
	/// images (Kabsch 1976, Acta Crystallographica A 32; with the given map's orientation).
	/// @param faces of these images; start from those of a map that is near, empty if none is known.
	Eigen::Isometry3d fitted(const Eigen::Isometry3d& map, std::vector<int>& faces) const
	{
		std::vector<Eigen::Vector3d> images;
		Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
		const bool isFirst = faces.empty();
		faces.resize(points.size());
		for (size_t i = 0; i < points.size(); ++i) {
			const Point3d image = mapped(map, points[i]);
			const ClosestSurface::Hit hit =
				isFirst ? closest.closest(image) : closest.closest(image, faces[i]);
			faces[i] = hit.face;
			images.push_back(toEigen(hit.point));
			from += toEigen(points[i]) / double(points.size());
			to += images.back() / double(points.size());
		}
		Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
		for (size_t i = 0; i < points.size(); ++i)
			covariance += (images[i] - to) * (toEigen(points[i]) - from).transpose();
		const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
			covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
		Eigen::Vector3d signs(1, 1, 1);
		const double turn = svd.matrixU().determinant() * svd.matrixV().determinant();
		if (turn * map.linear().determinant() < 0)
			signs[2] = -1;
		Eigen::Isometry3d better = Eigen::Isometry3d::Identity();
		better.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
		better.translation() = to - better.linear() * from;
		return rounded(better);
	}

	/// Whether the images are on the surface: in the mean nearer than `mean`, and all nearer than
	/// `farthest`. @param faces see fitted().
	bool holds(const Eigen::Isometry3d& map, const std::vector<int>& faces, double mean,
		double farthest) const
	{
		double sum = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			const double distance = closest.closest(mapped(map, points[i]), faces[i]).distance;
			if (distance > farthest)
				return false;
			sum += distance;
		}
		return sum <= mean * double(points.size());
	}

private:
	const ClosestSurface& closest;
	std::vector<Point3d> points;
};

/// Whether two maps turn in the same way, but for some degrees.
inline bool areAlike(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other)
{
	constexpr double same = 0.05; // difference of the matrices
	return (one.linear() - other.linear()).norm() < same;
}

/// Whether a map turns in the same way as one of several.
inline bool isAmong(const std::vector<Eigen::Isometry3d>& maps, const Eigen::Isometry3d& map)
{
	return std::any_of(
		maps.begin(), maps.end(), [&](const auto& known) { return areAlike(known, map); });
}

/// The vertices that are farthest in each of 26 directions, to the faces, edges and corners of a
/// cube; of several, the first by its place. @throws Cancelled. Complexity: O(V).
inline std::vector<int> outermost(
	const SurfaceMesh& mesh, const std::vector<int>& vertices, const Cancellation& cancel)
{
	std::vector<Point3d> ways;
	for (int x : {-1, 0, 1})
		for (int y : {-1, 0, 1})
			for (int z : {-1, 0, 1})
				if (x || y || z)
					ways.emplace_back(x, y, z);
	std::vector<int> found(ways.size(), vertices.front());
	cancellableLoop(int(vertices.size()), cancel, [&](int i) {
		const int v = vertices[size_t(i)];
		for (size_t k = 0; k < ways.size(); ++k) {
			const Point3d &one = mesh.position[v], &known = mesh.position[found[k]];
			const double farther = ways[k] * one - ways[k] * known;
			if (farther > 0 || (farther == 0 && one < known))
				found[k] = v;
		}
	});
	return found;
}

/// Some of the vertices, chosen and ordered by their places alone. @throws Cancelled
/// Complexity: O(V log V).
inline std::vector<Point3d> someOf(const SurfaceMesh& mesh, const std::vector<int>& vertices,
	size_t count, const Cancellation& cancel)
{
	std::vector<std::pair<std::uint64_t, Point3d>> drawn;
	drawn.reserve(vertices.size());
	cancellableLoop(int(vertices.size()), cancel, [&](int i) {
		const Point3d& p = mesh.position[vertices[size_t(i)]];
		drawn.emplace_back(scattered(p), p);
	});
	if (count < drawn.size()) {
		std::nth_element(drawn.begin(), drawn.begin() + std::ptrdiff_t(count), drawn.end());
		drawn.resize(count);
	}
	std::sort(drawn.begin(), drawn.end());
	std::vector<Point3d> points;
	for (const auto& [hash, p] : drawn)
		points.push_back(p);
	return points;
}

} // namespace detail

/**
 * All maps that some maps make up, without the identity. If there are more than those of a cube,
 * as where angles are nearly the same, the given ones alone.
 * Complexity: quadratic in the number of maps.
 */
inline std::vector<Eigen::Isometry3d> generatedGroup(
	const std::vector<Eigen::Isometry3d>& generators)
{
	constexpr size_t maximum = 48;
	std::vector<Eigen::Isometry3d> maps = {Eigen::Isometry3d::Identity()};
	for (size_t i = 0; i < maps.size(); ++i)
		for (const Eigen::Isometry3d& generator : generators) {
			const Eigen::Isometry3d map = generator * maps[i];
			if (detail::isAmong(maps, map))
				continue;
			if (maps.size() == maximum)
				return generators;
			maps.push_back(map);
		}
	maps.erase(maps.begin());
	return maps;
}

/// Whether maps, with the identity, are closed under composition; not where generatedGroup() gave up.
/// Complexity: cubic in their number.
inline bool isGroup(const std::vector<Eigen::Isometry3d>& maps)
{
	return std::all_of(maps.begin(), maps.end(), [&](const Eigen::Isometry3d& one) {
		return std::all_of(maps.begin(), maps.end(), [&](const Eigen::Isometry3d& other) {
			const Eigen::Isometry3d product = one * other;
			return detail::areAlike(product, Eigen::Isometry3d::Identity())
				|| detail::isAmong(maps, product);
		});
	});
}

/**
 * Finds the reflections and rotations that map some components of a surface, taken together, to
 * themselves: the images of points are within 0.15 % of the diagonal of it in the mean, and all,
 * those that are outermost among them, within 0.5 %. They generate the others, see generatedGroup().
 *
 * Candidates are reflections along the principal axes and half turns around them and, where moments
 * are alike as those of prisms and stars, rotations of up to the eighth order around the third
 * axis, and reflections in planes through it by the moments of these orders, in the planes of the
 * coordinates and in those halfway between them. So those of a cube are found if it is aligned with
 * the coordinates.
 */
class SymmetryFinder
{
public:
	/// @param mesh      compact; its diagonal is about 1.
	/// @param vertices  of these components.
	/// @param closest   of them.
	/// @throws Cancelled. Complexity: O(V + F).
	SymmetryFinder(const SurfaceMesh& mesh, const std::vector<int>& vertices,
		const ClosestSurface& closest, const Cancellation& cancel = Cancellation()) :
			candidates(mesh, vertices, cancel),
			cancel(cancel), fit(closest, samplesOf(mesh, vertices, cancel))
	{
	}

	/// The candidates that may be symmetries, as far as few points show; in a fixed order.
	/// @throws Cancelled. Complexity: some tens of closest points for each candidate.
	std::vector<Eigen::Isometry3d> possible() const
	{
		std::vector<Eigen::Isometry3d> maps;
		const auto add = [&](const Eigen::Isometry3d& map) {
			if (mayBe(map))
				maps.push_back(map);
			return false;
		};
		candidates.forEachReflection(add);
		candidates.forEachRotation(add);
		return maps;
	}

	/// The symmetries, fitted to the surface; in a fixed order.
	/// @throws Cancelled. Complexity: as possible(), and thousands of closest points for each of them.
	std::vector<Eigen::Isometry3d> found() const
	{
		constexpr double mean = 1.5e-3, farthest = 5e-3; // diagonals
		constexpr int rounds = 4;
		constexpr double settled = 1e-4;
		constexpr double hopeless = 3; // after the first round, by this factor; most candidates are
		std::vector<Eigen::Isometry3d> maps;
		const auto tryOut = [&](Eigen::Isometry3d map) {
			if (!mayBe(map))
				return false;
			std::vector<int> faces;
			for (int i = 0; i < rounds; ++i) {
				const Eigen::Isometry3d before = std::exchange(map, fit.fitted(map, faces));
				if ((map.matrix() - before.matrix()).norm() < settled)
					break;
				if (i == 0 && !fit.holds(map, faces, hopeless * mean, hopeless * farthest))
					return false;
			}
			if (!fit.holds(map, faces, mean, farthest)
				|| detail::areAlike(map, Eigen::Isometry3d::Identity()))
				return false;
			if (std::none_of(maps.begin(), maps.end(),
					[&](const auto& known) { return detail::areAlike(known, map); }))
				maps.push_back(map);
			return true;
		};
		candidates.forEachReflection(tryOut);
		candidates.forEachRotation(tryOut);
		return maps;
	}

private:
	static constexpr size_t samples = 300;
	detail::SymmetryCandidates candidates;
	Cancellation cancel;
	detail::SymmetryFit fit;

	static std::vector<Point3d> samplesOf(
		const SurfaceMesh& mesh, const std::vector<int>& vertices, const Cancellation& cancel)
	{
		std::vector<Point3d> points = detail::someOf(mesh, vertices, samples, cancel);
		// Corners and ends of limbs are few, but constrain a symmetry most.
		for (int v : detail::outermost(mesh, vertices, cancel))
			points.push_back(mesh.position[size_t(v)]);
		return points;
	}

	bool mayBe(const Eigen::Isometry3d& map) const
	{
		constexpr double near = 0.02; // diagonals
		constexpr size_t fewSamples = 25;
		cancel.check();
		return fit.isNear(map, fewSamples, near);
	}
};

} // namespace vcg::tri::mcf

#endif
