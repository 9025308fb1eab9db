// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"
#include "first_stage_of.h"

#include <skeleton/flow/check_stage.h>
#include <skeleton/flow/first_stage.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace vcg::tri::mcf;
using vcg::Point3d;
using Part = InvalidStage::Part;

namespace {

/// Two bodies after two steps.
const Stage& twoBodies()
{
	static const Stage stage = [] {
		Stage s = firstStageOf(shapes::joined({shapes::torus(1, 0.3, 24, 10),
												  shapes::moved(shapes::sphere(2), {9, 0, 0})})
								   .mesh(),
			Parameters());
		for (int i = 0; i < 2; ++i)
			s = step(std::move(s), Parameters());
		return s;
	}();
	return stage;
}

struct Wrong
{
	Part part;
	size_t row, count;
	std::string reason;
};

/// What checkStage() finds in a stage that something was done to.
Wrong found(const std::function<void(Stage&)>& change)
{
	Stage stage = twoBodies();
	change(stage);
	try {
		checkStage(stage);
	}
	catch (const InvalidStage& error) {
		EXPECT_NE(std::string(error.what()).find(error.reason()), std::string::npos);
		return {error.part(), error.row(), error.count(), error.reason()};
	}
	ADD_FAILURE() << "nothing was found";
	return {Part::Stage, 0, 0, ""};
}

constexpr double infinite = std::numeric_limits<double>::infinity();

} // namespace

TEST(CheckStage, PassesWhateverTheFlowMakesAtAnyScale)
{
	for (double scale : {1e-30, 1.0, 1e30}) {
		Stage stage = firstStageOf(shapes::scaled(shapes::joined({shapes::torus(1, 0.3, 24, 10),
													  shapes::moved(shapes::sphere(2), {9, 0, 0})}),
									   scale)
									   .mesh(),
			Parameters());
		EXPECT_NO_THROW(checkStage(stage)) << scale;
		while (!stage.converged && stage.iteration < 100) {
			stage = step(std::move(stage), Parameters());
			ASSERT_NO_THROW(checkStage(stage)) << scale << ", iteration " << stage.iteration;
		}
	}
}

TEST(CheckStage, NamesTheVertexThatIsWrongAndHowManyAre)
{
	const auto atVertex = [](size_t v, size_t count, const std::function<void(Stage&)>& change) {
		const Wrong wrong = found(change);
		EXPECT_EQ(wrong.part, Part::Vertex) << wrong.reason;
		EXPECT_EQ(wrong.row, v) << wrong.reason;
		EXPECT_EQ(wrong.count, count) << wrong.reason;
	};
	for (double x : {std::nan(""), infinite, -infinite, 1e228, -1e37, 1e6}) {
		atVertex(5, 2, [&](Stage& s) { s.mesh.position[5][1] = s.mesh.position[8][2] = x; });
		atVertex(5, 1, [&](Stage& s) {
			s.pole[5][0] = x;
			s.poleRadius[5] = 1;
		});
	}
	atVertex(6, 1, [](Stage& s) { s.poleRadius[6] = std::nan(""); });
	atVertex(6, 1, [](Stage& s) { s.poleRadius[6] = infinite; });
	atVertex(7, 1, [](Stage& s) { s.fixed[7] = 2; });
	atVertex(7, 1, [](Stage& s) { s.sheet[7] = -1; });
	atVertex(7, 1, [](Stage& s) {
		s.held[7] = 1;
		s.fixed[7] = 0;
	});
	atVertex(7, 1, [](Stage& s) {
		s.sheet[7] = 1;
		s.poleRadius[7] = -1;
	});
	for (double limit : {0.0, -1e-3, 0.2, std::nan("")})
		atVertex(3, 1, [&](Stage& s) {
			s.epsilonLimit.assign(s.pole.size(), 0.01);
			s.epsilonLimit[3] = limit;
		});
	atVertex(0, 1, [](Stage& s) { s.component[0] = -1; });
	atVertex(1, 1, [](Stage& s) { s.component[1] = 2; });
}

TEST(CheckStage, PolesOfVerticesThatHaveNoneMayBeAnywhere)
{
	Stage stage = twoBodies();
	stage.sheet[5] = 0;
	stage.poleRadius[5] = -1;
	for (double x : {std::nan(""), infinite, 1e36, -1e228}) {
		stage.pole[5] = Point3d(x, x, x);
		EXPECT_NO_THROW(checkStage(stage));
		EXPECT_NO_THROW(checkStage(step(stage, Parameters())));
	}
}

TEST(CheckStage, RefusesComponentsThatAreNot)
{
	EXPECT_EQ(found([](Stage& s) { s.component[3] = 1 - s.component[3]; }).part, Part::Face);
	const Wrong merged =
		found([](Stage& s) { std::fill(s.component.begin(), s.component.end(), 0); });
	EXPECT_EQ(merged.part, Part::Vertex);
	EXPECT_NE(merged.reason.find("not connected"), std::string::npos) << merged.reason;
	const Wrong unused = found([](Stage& s) {
		for (auto* of : {&s.diagonal, &s.area, &s.initialArea})
			of->push_back(1);
	});
	EXPECT_EQ(unused.part, Part::Component);
	EXPECT_EQ(unused.row, 2u);
}

TEST(CheckStage, RefusesMeasuresThatAreNoLengthsAreasOrVolumes)
{
	const auto component = [](const std::function<void(Stage&)>& change) {
		const Wrong wrong = found(change);
		EXPECT_EQ(wrong.part, Part::Component) << wrong.reason;
		EXPECT_EQ(wrong.row, 1u) << wrong.reason;
	};
	const auto whole = [](const std::function<void(Stage&)>& change) {
		const Wrong wrong = found(change);
		EXPECT_EQ(wrong.part, Part::Stage) << wrong.reason;
	};
	for (double value : {0.0, -1.0, std::nan(""), infinite, 1e-300}) {
		component([&](Stage& s) { s.diagonal[1] = value; });
		component([&](Stage& s) { s.initialArea[1] = value; });
		whole([&](Stage& s) { s.initialVolume = value; });
	}
	for (double value : {-1.0, std::nan(""), infinite})
		component([&](Stage& s) { s.area[1] = value; });
	for (double value : {std::nan(""), infinite, -infinite})
		whole([&](Stage& s) { s.volume = value; });
	for (double value : {0.0, -1.0, std::nan(""), infinite, 0.11})
		whole([&](Stage& s) { s.epsilon = value; });
	// The unit of length has to be that of the surface, or splits would not end.
	for (double factor : {0.01, 0.4, 2.5, 100.0})
		EXPECT_EQ(found([&](Stage& s) { s.diagonal[0] *= factor; }).part, Part::Component)
			<< factor;
}

TEST(CheckStage, RefusesIterationsThatCannotBeCountedOn)
{
	EXPECT_EQ(found([](Stage& s) { s.iteration = -1; }).part, Part::Stage);
	EXPECT_EQ(
		found([](Stage& s) { s.iteration = std::numeric_limits<int>::max(); }).part, Part::Stage);
}

TEST(CheckStage, RefusesACorrespondenceThatLeadsNowhere)
{
	const auto atSurface = [](const std::function<void(Stage&)>& change) {
		const Wrong wrong = found(change);
		EXPECT_EQ(wrong.part, Part::SurfaceVertex);
		EXPECT_EQ(wrong.row, 4u);
	};
	atSurface([](Stage& s) { s.node[4] = -1; });
	atSurface([](Stage& s) { s.node[4] = s.mesh.vertexSlots(); });
	atSurface([](Stage& s) {
		auto surface = *s.surface;
		surface[4][0] = 1e228;
		s.surface = std::make_shared<const std::vector<Point3d>>(surface);
	});
	EXPECT_EQ(found([](Stage& s) { s.node.pop_back(); }).part, Part::Stage);
	EXPECT_EQ(found([](Stage& s) { s.surface = nullptr; }).part, Part::Stage);
	const Wrong alone = found([](Stage& s) {
		// All of the surface belongs to one body.
		const int v =
			int(std::find(s.component.begin(), s.component.end(), 0) - s.component.begin());
		std::fill(s.node.begin(), s.node.end(), v);
	});
	EXPECT_EQ(alone.part, Part::Component);
}

TEST(CheckStage, RefusesMeshesThatAreNoClosedManifold)
{
	const auto withTriangles = [](const std::function<void(Stage&)>& change) {
		return found([&](Stage& s) {
			change(s);
			const size_t n = s.mesh.position.size();
			s.pole.resize(n, Point3d(0, 0, 0));
			s.poleRadius.resize(n, -1);
			s.component.resize(n, 0);
			s.epsilonLimit.clear();
			for (auto* flags : {&s.fixed, &s.held, &s.sheet})
				flags->resize(n, 0);
		});
	};
	const Wrong unused = withTriangles([](Stage& s) {
		std::vector<Point3d> points = s.mesh.position;
		points.push_back(points[0]);
		s.mesh = SurfaceMesh(points, s.mesh.triangles());
	});
	EXPECT_EQ(unused.part, Part::Vertex);
	EXPECT_EQ(unused.row, twoBodies().mesh.position.size());
	// Two vertices that are not neighbours become one.
	const Wrong pinched = withTriangles([](Stage& s) {
		std::vector<Triangle> triangles = s.mesh.triangles();
		const int a = 0;
		int b = -1;
		for (int v = 1; v < s.mesh.vertexSlots() && b < 0; ++v) {
			bool near = s.component[v] != s.component[a];
			s.mesh.forEachOutgoing(a, [&](int h) {
				near |= s.mesh.target(h) == v || s.mesh.findHalfEdge(s.mesh.target(h), v) >= 0;
			});
			if (!near)
				b = v;
		}
		for (Triangle& t : triangles)
			for (int& v : t)
				if (v == b)
					v = a;
		// The last vertex takes the free place.
		const int last = s.mesh.vertexSlots() - 1;
		for (Triangle& t : triangles)
			for (int& v : t)
				if (v == last)
					v = b;
		std::vector<Point3d> points = s.mesh.position;
		const auto takePlace = [&](auto& values) {
			values[b] = values[last];
			values.pop_back();
		};
		takePlace(points);
		takePlace(s.pole);
		takePlace(s.poleRadius);
		takePlace(s.fixed);
		takePlace(s.held);
		takePlace(s.sheet);
		takePlace(s.component);
		if (!s.epsilonLimit.empty())
			takePlace(s.epsilonLimit);
		for (int& node : s.node)
			node = node == b ? a : node == last ? b : node;
		s.mesh = SurfaceMesh(points, triangles);
	});
	EXPECT_EQ(pinched.part, Part::Vertex);
	EXPECT_EQ(pinched.row, 0u);
	EXPECT_NE(pinched.reason.find("pinched"), std::string::npos);
}

TEST(CheckStage, CanBeCancelled)
{
	const Progress stop([](int, const char*) { return false; });
	EXPECT_THROW(checkStage(twoBodies(), stop), Cancelled);
}

TEST(CheckStage, TheBarRunsForwardOnce)
{
	const Stage stage = firstStageOf(shapes::sphere(7).mesh(), Parameters());
	int last = 0;
	checkStage(stage, Progress([&](int percent, const char*) {
		EXPECT_GE(percent, last);
		last = percent;
		return true;
	}));
	EXPECT_GE(last, 90);
}
