// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "curves.h"
#include "read_off.h"
#include "shapes.h"

#include <skeleton/skeletonize.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

Parameters coarse()
{
	Parameters parameters;
	parameters.targetLength = 0.03;
	return parameters;
}

Skeletonization run(
	const shapes::Soup& soup, const Parameters& parameters, const Observer& observer = Observer())
{
	return skeletonize(soup.points, soup.triangles, parameters, Progress(), observer);
}

void expectSame(const CurveSkeleton& a, const CurveSkeleton& b)
{
	EXPECT_EQ(a.position, b.position);
	EXPECT_EQ(a.edges, b.edges);
	EXPECT_EQ(a.radius, b.radius);
	EXPECT_EQ(a.node, b.node);
}

bool differ(const CurveSkeleton& a, const CurveSkeleton& b)
{
	return a.position != b.position || a.edges != b.edges;
}

/// A flat box: a shape with a sheet.
shapes::Soup plainSlab()
{
	return shapes::transformed(
		shapes::plate(0, 12), [](const Point3d& p) { return Point3d(p[0], p[1], p[2] / 8); });
}

} // namespace

TEST(Skeletonize, IsFig4LineByLine)
{
	const shapes::Soup soup = shapes::fromFile("animal450");
	const Parameters parameters = coarse();
	const SurfaceMesh input =
		checkedSurface(roundedCoordinates(soup.points, soup.triangles), soup.triangles).mesh;
	const SurfaceMesh surface = resampledSurface(input, parameters).mesh;
	const PoleSet poles = medialPoles(surface, parameters.poleMethod);
	Stage stage = startOfFlow(surface, poles, {}, parameters);
	while (!stage.converged)
		stage = step(stage, parameters);
	const CurveSkeleton curve = refine(collapseInside(stage, parameters.epsilon), surface);

	const Skeletonization result = run(soup, parameters);
	expectSame(result.curve, curve);
	EXPECT_EQ(result.surface->position, surface.position);
	EXPECT_EQ(result.poles->centre, poles.centre);
	EXPECT_EQ(result.stage->mesh.position, stage.mesh.position);
	EXPECT_EQ(result.stage->iteration, stage.iteration);
	EXPECT_TRUE(result.refined);
	EXPECT_FALSE(result.sheets);
}

TEST(Skeletonize, NodesOfTheInputAreNear)
{
	shapes::Soup soup = shapes::fromFile("animal450");
	soup.points.push_back(soup.points.front() * 2); // no face uses it
	const Skeletonization result = run(soup, coarse());
	ASSERT_EQ(result.node.size(), soup.points.size());
	EXPECT_EQ(result.node.back(), -1);
	double sum = 0, sumNearest = 0;
	for (size_t v = 0; v + 1 < soup.points.size(); ++v) {
		ASSERT_GE(result.node[v], 0);
		ASSERT_LT(result.node[v], int(result.curve.position.size()));
		sum += Distance(soup.points[v], result.curve.position[result.node[v]]);
		double nearest = 1e9;
		for (const Point3d& p : result.curve.position)
			nearest = std::min(nearest, Distance(soup.points[v], p));
		sumNearest += nearest;
	}
	EXPECT_LT(sum, 1.5 * sumNearest);
}

TEST(Skeletonize, DoubleAndSinglePrecisionGiveTheSameBits)
{
	const shapes::Soup soup = shapes::fromFile("letter_p");
	shapes::Soup single = soup;
	for (Point3d& p : single.points)
		for (int k = 0; k < 3; ++k)
			p[k] = double(float(p[k]));
	shapes::Soup beyond = single;
	for (Point3d& p : beyond.points)
		p *= 1 + 1e-12;
	const Skeletonization expected = run(single, coarse());
	expectSame(run(soup, coarse()).curve, expected.curve);
	expectSame(run(beyond, coarse()).curve, expected.curve);
}

TEST(Skeletonize, AMirroredShapeHasTheMirroredSkeleton)
{
	// One that is symmetric, but for its triangles, and one that is not.
	for (const char* name : {"hand", "horn"}) {
		const shapes::Soup soup = shapes::fromFile(name);
		const Skeletonization expected = run(soup, coarse());
		const double tolerance = 1e-12 * expected.surface->bounds().Diag();
		for (int k = 0; k < 3; ++k) {
			const auto mirror = [&](vcg::Point3d p) {
				p[k] = -p[k];
				return p;
			};
			const CurveSkeleton image =
				run(shapes::insideOut(shapes::transformed(soup, mirror)), coarse()).curve;
			EXPECT_EQ(image.edges, expected.curve.edges);
			ASSERT_EQ(image.position.size(), expected.curve.position.size());
			for (size_t v = 0; v < image.position.size(); ++v)
				ASSERT_LT(
					Distance(mirror(image.position[v]), expected.curve.position[v]), tolerance);
		}
	}
}

TEST(Skeletonize, ASymmetricShapeHasNoBranchWithoutItsImage)
{
	const auto about = [](double x, double y, double z) {
		return shapes::moved(
			shapes::refined(shapes::box(x, y, z), 4), Point3d(-x / 2, -y / 2, -z / 2));
	};
	const std::vector<shapes::Soup> bodies = {
		about(4, 3, 0.5), about(6, 1, 0.3), about(5, 2, 0.5), about(2, 1, 0.5),
		shapes::jittered(about(4, 3, 0.5), 0.005), // a thousandth of its diagonal
	};
	for (const shapes::Soup& soup : bodies) {
		vcg::Box3d box;
		for (const Point3d& p : soup.points)
			box.Add(p);
		Parameters parameters;
		parameters.targetLength = 0.008;
		const std::vector<Point3d> tips = curves::tips(run(soup, parameters).curve);
		EXPECT_GE(tips.size(), 2u);
		for (const Point3d& tip : tips)
			for (int axis = 0; axis < 3; ++axis) {
				Point3d image = tip;
				image[axis] = -image[axis];
				EXPECT_TRUE(std::any_of(tips.begin(), tips.end(),
					[&](const Point3d& other) {
						return Distance(image, other) < 0.02 * box.Diag();
					}))
					<< tips.size() << " tips, axis " << axis << ", box of " << box.DimX() << " x "
					<< box.DimY() << " x " << box.DimZ();
			}
	}
}

TEST(Skeletonize, ARegularPlateHasABranchIntoEachCorner)
{
	constexpr double turned = 0.3, thickness = 0.1, farthest = 0.15;
	for (int sides = 3; sides <= 8; ++sides) {
		const std::vector<Point3d> tips =
			curves::tips(run(shapes::prism(sides, thickness, turned), Parameters()).curve);
		EXPECT_EQ(tips.size(), size_t(sides));
		for (int i = 0; i < sides; ++i) {
			const double angle = 2 * M_PI * i / sides + turned;
			const Point3d corner(std::cos(angle), std::sin(angle), thickness / 2);
			EXPECT_TRUE(std::any_of(tips.begin(), tips.end(),
				[&](const Point3d& tip) { return Distance(tip, corner) < farthest; }))
				<< "corner " << i << " of " << sides;
		}
	}
}

TEST(Skeletonize, TheWallsOfPlatesHaveNoBranches)
{
	const auto isNearOne = [](const std::vector<Point3d>& places, const Point3d& tip) {
		return std::any_of(places.begin(), places.end(),
			[&](const Point3d& place) { return Distance(tip, place) < 3.5; });
	};
	// A chair: four legs, and two corners of its back; none in the middles of the seat's sides.
	const shapes::Soup chair = shapes::cells(24, 24, 50, [](int i, int j, int k) {
		const bool isAtLeg = (i < 2 || i >= 22) && (j < 2 || j >= 22);
		return (k < 20 && isAtLeg) || (k >= 20 && k < 22) || (k >= 22 && j >= 22);
	});
	std::vector<Point3d> ends = {{1, 23, 49}, {23, 23, 49}};
	for (const double x : {1, 23})
		for (const double y : {1, 23})
			ends.push_back({x, y, 1});
	const std::vector<Point3d> tips = curves::tips(run(chair, Parameters()).curve);
	EXPECT_EQ(tips.size(), ends.size());
	for (const Point3d& tip : tips)
		EXPECT_TRUE(isNearOne(ends, tip)) << tip[0] << " " << tip[1] << " " << tip[2];
	// A plate with two holes: no branch ends at their rims, nor in the face between them.
	const shapes::Soup plate = shapes::cells(60, 40, 4, [](int i, int j, int) {
		const auto isInHole = [&](double x, double y, double radius) {
			return std::hypot(i + 0.5 - x, j + 0.5 - y) < radius;
		};
		return !isInHole(38, 12, 5) && !isInHole(38, 28, 5);
	});
	std::vector<Point3d> corners;
	for (const double x : {1.5, 58.5})
		for (const double y : {1.5, 38.5})
			corners.push_back({x, y, 2});
	for (const Point3d& tip : curves::tips(run(plate, Parameters()).curve))
		EXPECT_TRUE(isNearOne(corners, tip)) << tip[0] << " " << tip[1] << " " << tip[2];
}

TEST(Skeletonize, ReadsEveryParameter)
{
	const shapes::Soup soup = shapes::fromFile("animal450");
	const Skeletonization expected = run(soup, coarse());
	const auto with = [&](const auto& change) {
		Parameters parameters = coarse();
		change(parameters);
		return run(soup, parameters);
	};
	const auto changesCurve = [&](const auto& change) {
		return differ(with(change).curve, expected.curve);
	};
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.wL = 2; }));
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.wH = 30; }));
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.wM = 10; }));
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.epsilon = 0.004; }));
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.splitAngle = 100; }));
	EXPECT_TRUE(changesCurve([](Parameters& p) { p.resampleIterations = 2; }));

	const Skeletonization fine = with([](Parameters& p) { p.targetLength = 0.02; });
	EXPECT_GT(fine.surface->vertexCount(), 1.8 * expected.surface->vertexCount());
	const Skeletonization chosen = with([](Parameters& p) { p.targetLength = 0; });
	EXPECT_GT(chosen.surface->vertexCount(), 3000);
	const Skeletonization raw = with([](Parameters& p) { p.resample = false; });
	EXPECT_EQ(raw.surface->vertexCount(), int(soup.points.size()));
	const Skeletonization one = with([](Parameters& p) { p.maxIterations = 1; });
	EXPECT_EQ(one.stage->iteration, 1);
	EXPECT_FALSE(one.stage->converged);
	const Skeletonization voronoi = with([](Parameters& p) { p.poleMethod = PoleMethod::Voronoi; });
	EXPECT_NE(voronoi.poles->centre, expected.poles->centre);
	const Skeletonization unrefined = with([](Parameters& p) { p.refine = false; });
	EXPECT_FALSE(unrefined.refined);
	expectSame(unrefined.curve, collapseInside(*expected.stage, coarse().epsilon));
}

TEST(Skeletonize, DenoisesUnlessToldNotTo)
{
	const shapes::Soup clean = shapes::fromFile("capsule");
	const double diagonal = clean.mesh().bounds().Diag();
	const shapes::Soup noisy = shapes::jittered(clean, 0.004 * diagonal);
	Parameters parameters = coarse();
	const Skeletonization calm = run(noisy, parameters);
	EXPECT_GT(calm.noise.level, 3e-4);
	parameters.denoise = false;
	const Skeletonization rough = run(noisy, parameters);
	EXPECT_EQ(rough.noise.level, calm.noise.level);
	EXPECT_TRUE(differ(calm.curve, rough.curve));
	EXPECT_EQ(run(clean, parameters).noise.isNoisy(), false);
}

TEST(Skeletonize, NoiseAsLargeAsTheEdgesLeavesTheShape)
{
	// Nearly all triangles cross others, and the balls between them are small all over.
	const shapes::Soup ring = shapes::torus(1, 0.3, 240, 72); // edges of 0.026
	for (const double noise : {0.015, 0.03, 0.05}) {
		const Skeletonization result = run(shapes::jittered(ring, noise), Parameters());
		EXPECT_LT(result.surface->vertexCount(), 60000) << noise;
		const SkeletonStatistics found = statistics(result.curve);
		EXPECT_EQ(found.components, 1) << noise;
		EXPECT_EQ(found.cycles, 1) << noise;
		EXPECT_EQ(found.terminals, 0) << noise;
	}
}

TEST(Skeletonize, NoiseOfThinPartsGrowsNoTips)
{
	// A ring three thousandths of its size thick, with noise of up to half of that.
	const double radius = 0.01;
	const shapes::Soup ring = shapes::torus(1, radius, 800, 10);
	for (const double noise : {0.1, 0.3, 0.5}) {
		const Skeletonization result = run(shapes::jittered(ring, noise * radius), Parameters());
		const SkeletonStatistics found = statistics(result.curve);
		EXPECT_EQ(found.components, 1) << noise;
		EXPECT_EQ(found.cycles, 1) << noise;
		EXPECT_EQ(found.terminals, 0) << noise;
		EXPECT_TRUE(result.refined) << noise;
	}
}

TEST(Skeletonize, KeepsSheetsWhereAskedTo)
{
	Parameters parameters = coarse();
	EXPECT_FALSE(run(plainSlab(), parameters).sheets);
	parameters.keepSheets = true;
	std::vector<std::string> notes;
	Observer observer;
	observer.onNote = [&](const std::string& note) { notes.push_back(note); };
	const Skeletonization kept = run(plainSlab(), parameters, observer);
	ASSERT_TRUE(kept.sheets);
	EXPECT_FALSE(kept.refined);
	EXPECT_GT(kept.sheets->skeleton.faces.size(), 10u);
	const BettiNumbers b = kept.sheets->skeleton.betti();
	EXPECT_EQ((std::vector<int> {b.b0, b.b1, b.b2}), (std::vector<int> {1, 0, 0}));
	EXPECT_EQ(kept.nodeOfSurface().size(), kept.surface->position.size());
	EXPECT_EQ(kept.node.size(), plainSlab().points.size());
	const auto says = [&](const std::string& words) {
		return std::any_of(notes.begin(), notes.end(),
			[&](const std::string& note) { return note.find(words) != std::string::npos; });
	};
	EXPECT_TRUE(says("Keeping sheets"));
	EXPECT_TRUE(says("not refined"));
	parameters.sheetThreshold = 1;
	EXPECT_FALSE(run(plainSlab(), parameters).sheets);
}

TEST(Skeletonize, HeldVerticesAreNodes)
{
	const shapes::Soup soup = shapes::capsule();
	SurfaceInput input {std::make_shared<const SurfaceMesh>(soup.mesh())};
	input.held.assign(soup.points.size(), 0);
	input.held[7] = 1;
	Parameters parameters = coarse();
	parameters.resample = false;
	const Skeletonization result = skeletonize(input, parameters);
	EXPECT_FALSE(result.refined);
	EXPECT_EQ(result.curve.position[result.node[7]], soup.points[7]);
	parameters.resample = true;
	EXPECT_EQ(skeletonize(input, parameters).stage->heldCount(), 1);
}

TEST(Skeletonize, TakesPolesThatAreKnown)
{
	const shapes::Soup soup = shapes::capsule();
	SurfaceInput input {std::make_shared<const SurfaceMesh>(soup.mesh())};
	Parameters parameters;
	parameters.resample = false;
	const Skeletonization expected = skeletonize(input, parameters);
	input.poles = expected.poles;
	const Skeletonization result = skeletonize(input, parameters);
	EXPECT_EQ(result.poles, input.poles);
	expectSame(result.curve, expected.curve);
	parameters.resample = true;
	EXPECT_NE(skeletonize(input, parameters).poles, input.poles); // they are of another surface
}

TEST(Skeletonize, ReportsPhasesStagesAndNotes)
{
	Observer observer;
	std::vector<Phase> phases;
	std::vector<int> iterations, kept;
	observer.onPhase = [&](Phase phase) { phases.push_back(phase); };
	observer.onFigures = [&](const StageFigures& f) { iterations.push_back(f.iteration); };
	observer.onStage = [&](const Stage& stage) { kept.push_back(stage.iteration); };
	observer.every = 3;
	std::vector<std::string> notes;
	observer.onNote = [&](const std::string& note) { notes.push_back(note); };
	const Skeletonization result = run(shapes::insideOut(shapes::capsule()), coarse(), observer);
	EXPECT_EQ(phases,
		(std::vector<Phase> {Phase::Check, Phase::Resample, Phase::Poles, Phase::Contraction,
			Phase::Collapse, Phase::Refine}));
	ASSERT_EQ(int(iterations.size()), result.stage->iteration);
	for (size_t i = 0; i < iterations.size(); ++i)
		EXPECT_EQ(iterations[i], int(i) + 1);
	ASSERT_EQ(int(kept.size()), result.stage->iteration / 3);
	for (size_t i = 0; i < kept.size(); ++i)
		EXPECT_EQ(kept[i], 3 * (int(i) + 1));
	ASSERT_EQ(notes.size(), 2u);
	EXPECT_NE(notes[0].find("inside out"), std::string::npos);
	EXPECT_NE(notes[1].find("Resampled to"), std::string::npos);
	const PhaseSeconds& s = result.seconds;
	for (double seconds : {s.check, s.resample, s.poles, s.contraction, s.collapse, s.refine})
		EXPECT_GT(seconds, 0);
}

TEST(Skeletonize, JoinsPiecesOnlyIfAsked)
{
	const shapes::Soup torn =
		shapes::joined({shapes::capsule(), shapes::moved(shapes::capsule(), {0, 0, 3})});
	Parameters parameters = coarse();
	const Skeletonization apart = run(torn, parameters);
	EXPECT_EQ(statistics(apart.curve).components, 2);
	EXPECT_TRUE(apart.curve.bridge.empty());
	parameters.join = true;
	const Skeletonization joined = run(torn, parameters);
	EXPECT_EQ(joined.bridges.count, 1);
	const SkeletonStatistics s = statistics(joined.curve);
	EXPECT_EQ(s.components, 1);
	EXPECT_EQ(s.cycles, 0);
	// The curves themselves are the same.
	ASSERT_EQ(joined.curve.position.size(), apart.curve.position.size() + 1);
	for (size_t i = 0; i < apart.curve.position.size(); ++i)
		EXPECT_TRUE(joined.curve.position[i] == apart.curve.position[i]);
}

TEST(Skeletonize, PlacesNoCurveInACavity)
{
	const shapes::Soup hollow = shapes::joined(
		{shapes::capsule(), shapes::insideOut(shapes::scaled(shapes::capsule(), 0.4))});
	const Skeletonization result = run(hollow, coarse());
	EXPECT_EQ(statistics(result.curve).components, 1);
	EXPECT_EQ(result.solid.leftOut.cavities, 1);
	EXPECT_EQ(result.node.size(), hollow.points.size());
	EXPECT_EQ(result.node.back(), -1);
	EXPECT_GE(result.node.front(), 0);
}

TEST(Skeletonize, SaysHowMuchOfTheCurveLiesInACavity)
{
	// The axis of a capsule of half length 1: what is within the cavity, 0.4 as long, is not the solid's.
	const shapes::Soup hollow = shapes::joined(
		{shapes::capsule(), shapes::insideOut(shapes::scaled(shapes::capsule(), 0.4))});
	std::vector<std::string> notes;
	Observer observer;
	observer.onNote = [&](const std::string& note) { notes.push_back(note); };
	const Skeletonization result =
		skeletonize(hollow.points, hollow.triangles, coarse(), Progress(), observer);
	EXPECT_GT(result.inCavities, 0.3);
	EXPECT_LT(result.inCavities, 0.7);
	const auto said = [&](const char* words) {
		return std::count_if(notes.begin(), notes.end(),
			[&](const std::string& note) { return note.find(words) != std::string::npos; });
	};
	EXPECT_EQ(said("a cavity"), 1);
	EXPECT_EQ(said("lies in cavities"), 1);

	// A cavity beside the axis is in nobody's way.
	const shapes::Soup aside = shapes::joined({shapes::capsule(),
		shapes::insideOut(shapes::moved(shapes::sphere(2, 0.03), {0, 0.25, 0}))});
	notes.clear();
	const Skeletonization clear =
		skeletonize(aside.points, aside.triangles, coarse(), Progress(), observer);
	EXPECT_EQ(clear.inCavities, 0);
	EXPECT_EQ(said("a cavity"), 1);
	EXPECT_EQ(said("lies in cavities"), 0);
}

TEST(Skeletonize, SaysWhenItHasNotConverged)
{
	Observer observer;
	std::vector<std::string> notes;
	observer.onNote = [&](const std::string& note) { notes.push_back(note); };
	Parameters parameters = coarse();
	parameters.maxIterations = 2;
	run(shapes::capsule(), parameters, observer);
	EXPECT_EQ(notes.back(), "The contraction has not converged after 2 iterations.");
}

TEST(Skeletonize, CancelsInEveryPhase)
{
	const shapes::Soup soup = shapes::capsule();
	for (int percent : {0, 1, 5, 20, 50, 86, 95}) {
		const Progress progress([&](int done, const char*) { return done < percent; });
		EXPECT_THROW(skeletonize(soup.points, soup.triangles, coarse(), progress), Cancelled)
			<< percent;
	}
}

TEST(Skeletonize, RefusesBadInput)
{
	const shapes::Soup soup = shapes::capsule();
	const auto defect = [](const shapes::Soup& bad) {
		try {
			Parameters parameters = coarse();
			parameters.repair = Repair::Off;
			run(bad, parameters);
		}
		catch (const InvalidInput& error) {
			const std::string text = error.what();
			for (const char* word : {"layer", "Run '", "run '"})
				EXPECT_EQ(text.find(word), std::string::npos) << text;
			return error.defect();
		}
		ADD_FAILURE() << "not refused";
		return Defect::Other;
	};
	EXPECT_EQ(defect({}), Defect::Empty);
	EXPECT_EQ(defect({soup.points, {}}), Defect::NoFaces);
	EXPECT_EQ(defect(shapes::opened(soup)), Defect::BorderEdges);
	EXPECT_EQ(defect(shapes::kleinBottle()), Defect::OneSided);
	EXPECT_EQ(defect(shapes::tetrahedraSharingEdge()), Defect::NonManifoldEdges);
	EXPECT_EQ(defect(shapes::tetrahedraSharingVertex()), Defect::NonManifoldVertices);
	EXPECT_EQ(
		defect(shapes::transformed(soup, [](const Point3d& p) { return Point3d(p[0], p[1], 0); })),
		Defect::Flat);
	EXPECT_EQ(defect(shapes::transformed(
				  soup, [](const Point3d& p) { return Point3d(p[0] / 0.0, p[1], p[2]); })),
		Defect::NotFinite);

	Parameters parameters = coarse();
	parameters.epsilon = 0;
	EXPECT_THROW(run(soup, parameters), InvalidParameter);
	RefineParameters refinement;
	refinement.spacing = 0;
	EXPECT_THROW(
		skeletonize(soup.points, soup.triangles, coarse(), Progress(), Observer(), refinement),
		InvalidParameter);
}

TEST(Notes, WriteNumbersAlikeInEveryLocale)
{
	EXPECT_EQ(
		detail::sentence(3, "about ", 1234.5678, " or ", 0.25, '.'), "about 1.23e+03 or 0.25.");
	EXPECT_EQ(detail::number(0.123456, 2), "0.12");
}

TEST(SurfaceRounding, LeavesSurfacesFarAwayAlone)
{
	const std::vector<Triangle> faces = {{0, 1, 1}};
	const std::vector<Point3d> near = {{0.1, 0, 0}, {1, 1, 1}};
	EXPECT_EQ(roundedCoordinates(near, faces)[0][0], double(0.1f));
	std::vector<Point3d> far = {{1e6 + 0.1, 0, 0}, {1e6 + 1, 1, 1}};
	EXPECT_EQ(roundedCoordinates(far, faces), far);
	far.push_back({0, 0, 0});
	EXPECT_EQ(roundedCoordinates(far, faces), far) << "a vertex of no face does not count";
	// Beyond the largest number of single precision, and near its smallest one.
	for (double scale : {1e39, 1e-42, 1e-60}) {
		std::vector<Point3d> own = near;
		for (Point3d& p : own)
			p = p * scale;
		EXPECT_EQ(roundedCoordinates(own, faces), own) << scale;
	}
}

TEST(TransferredNodes, AreThoseOfTheNearestVertex)
{
	const SurfaceMesh from = shapes::sphere(2).mesh(), to = shapes::sphere(3).mesh();
	std::vector<int> side;
	for (const Point3d& p : from.position)
		side.push_back(p[0] > 0);
	const std::vector<int> found = transferredNodes(from, side, to);
	for (int v = 0; v < to.vertexSlots(); ++v)
		if (std::abs(to.position[v][0]) > 0.3) {
			EXPECT_EQ(found[v], to.position[v][0] > 0);
		}
}

namespace {

/// A thick tube along the x axis with a thin one at its end, whose last ball is at x = 2.
shapes::Soup twigOnTrunk(double trunk, double twig)
{
	std::vector<std::pair<double, double>> profile = {{-2, 0}};
	for (int i = 1; i <= 12; ++i)
		profile.emplace_back(
			-2 + trunk - trunk * std::cos(i * M_PI / 24), trunk * std::sin(i * M_PI / 24));
	for (double x = -2 + trunk + 0.06; x < 0; x += 0.06)
		profile.emplace_back(x, trunk);
	for (int i = 1; trunk * std::cos(i * M_PI / 64) > twig; ++i)
		profile.emplace_back(trunk * std::sin(i * M_PI / 64), trunk * std::cos(i * M_PI / 64));
	for (double x = trunk + 2 * twig; x < 2; x += 2 * twig)
		profile.emplace_back(x, twig);
	for (int i = 0; i < 6; ++i)
		profile.emplace_back(2 + twig * std::sin(i * M_PI / 12), twig * std::cos(i * M_PI / 12));
	profile.emplace_back(2 + twig, 0);
	return shapes::revolved(profile, 20);
}

} // namespace

TEST(Skeletonize, ATwigOfATenthOfAPercentIsFollowedToItsEndInItsMiddle)
{
	constexpr double trunk = 0.3, twig = 0.004; // of a diagonal of some 4.1
	const shapes::Soup soup = twigOnTrunk(trunk, twig);
	const Skeletonization result = skeletonize(soup.points, soup.triangles);
	EXPECT_EQ(result.refined, 1);
	const CurveSkeleton& curve = result.curve;
	const SkeletonStatistics counts = statistics(curve);
	EXPECT_EQ(counts.components, 1);
	EXPECT_EQ(counts.terminals, 2);
	EXPECT_EQ(counts.cycles, 0);
	double last = -2;
	for (const Point3d& p : curve.position) {
		last = std::max(last, p[0]);
		const double aside = std::hypot(p[1], p[2]);
		EXPECT_LT(aside, p[0] > trunk ? twig / 2 : trunk / 10);
	}
	EXPECT_NEAR(last, 2, twig); // the centre of the last ball
}

TEST(Skeletonize, LengthsThatDoNotFollowTheThicknessAreThoseOfTheThickPart)
{
	const shapes::Soup soup = twigOnTrunk(0.3, 0.004);
	Parameters uniform;
	uniform.adaptive = false;
	const Skeletonization plain = skeletonize(soup.points, soup.triangles, uniform);
	EXPECT_TRUE(plain.stage->epsilonLimit.empty());
	const Skeletonization result = skeletonize(soup.points, soup.triangles);
	EXPECT_FALSE(result.stage->epsilonLimit.empty());
	EXPECT_GT(result.surface->vertexCount(), plain.surface->vertexCount());
}

TEST(Skeletonize, OnAShapeOfOneScaleAdaptingChangesNothing)
{
	const shapes::Soup soup = shapes::torus(1, 0.3, 60, 20);
	Parameters uniform;
	uniform.adaptive = false;
	const Skeletonization plain = skeletonize(soup.points, soup.triangles, uniform);
	const Skeletonization result = skeletonize(soup.points, soup.triangles);
	EXPECT_EQ(result.curve.position, plain.curve.position);
	EXPECT_EQ(result.curve.edges, plain.curve.edges);
	EXPECT_TRUE(result.stage->epsilonLimit.empty());
}

TEST(Skeletonize, APlateThinnerThanItsResampledEdgesIsContractedAsItIs)
{
	constexpr double breadth = 1, depth = 0.8, thickness = 0.001; // 0.08 % of the diagonal
	shapes::Soup soup = shapes::box(breadth, depth, thickness);
	for (int i = 0; i < 3; ++i)
		soup = shapes::subdivided(soup);
	Observer observer;
	std::vector<int> kept;
	std::string notes;
	observer.onStage = [&](const Stage& stage) { kept.push_back(stage.iteration); };
	observer.onStartOver = [&] { kept.clear(); };
	observer.onNote = [&](const std::string& note) { notes += note; };
	const Skeletonization result = run(soup, Parameters(), observer);
	EXPECT_EQ(result.refined, 1);
	EXPECT_NE(notes.find("as it is"), std::string::npos);
	EXPECT_EQ(result.surface->vertexCount(), int(soup.points.size()));
	ASSERT_EQ(int(kept.size()), result.stage->iteration);
	for (size_t i = 0; i < kept.size(); ++i)
		EXPECT_EQ(kept[i], int(i) + 1);
	const SkeletonStatistics counts = statistics(result.curve);
	EXPECT_EQ(counts.components, 1);
	EXPECT_EQ(counts.cycles, 0);
	EXPECT_LT(counts.length, 3 * std::hypot(breadth, depth));
	vcg::Box3d bounds;
	for (const Point3d& p : soup.points)
		bounds.Add(p);
	for (const Point3d& p : result.curve.position)
		for (int k = 0; k < 3; ++k) {
			EXPECT_GT(p[k], bounds.min[k]);
			EXPECT_LT(p[k], bounds.max[k]);
		}
}

TEST(Skeletonize, OfSeveralComponentsOnlyTheThinOneIsContractedAsItIs)
{
	shapes::Soup plate = shapes::box(1, 0.8, 0.001); // 0.08 % of the diagonal thick
	for (int i = 0; i < 3; ++i)
		plate = shapes::subdivided(plate);
	const shapes::Soup soup = shapes::joined({shapes::capsule(2, 0.35, 24),
		shapes::moved(plate, {3, 0, 0}), shapes::moved(shapes::torus(1, 0.3), {0, 4, 0})});
	Observer observer;
	std::string notes;
	int startedOver = 0;
	observer.onStartOver = [&] { ++startedOver; };
	observer.onNote = [&](const std::string& note) { notes += note + "\n"; };
	const Skeletonization result = run(soup, Parameters(), observer);
	EXPECT_EQ(result.refined, 1);
	EXPECT_EQ(result.refinement.refined, 3);
	EXPECT_NE(notes.find("1 of 3 components is too thin"), std::string::npos) << notes;
	EXPECT_EQ(startedOver, 0) << "the stages are those of the resampling";
	EXPECT_EQ(statistics(result.curve).components, 3);
	EXPECT_EQ(statistics(result.curve).cycles, 1);
	EXPECT_EQ(result.curve.radius.size(), result.curve.position.size());
	EXPECT_EQ(result.curve.significance.size(), result.curve.position.size());
	EXPECT_TRUE(std::is_sorted(result.curve.edges.begin(), result.curve.edges.end()));

	// The plate's curve is that of the plate alone, and comes last.
	const CurveSkeleton alone = run(shapes::moved(plate, {3, 0, 0}), Parameters()).curve;
	ASSERT_GT(result.curve.position.size(), alone.position.size());
	const size_t first = result.curve.position.size() - alone.position.size();
	EXPECT_TRUE(std::equal(alone.position.begin(), alone.position.end(),
		result.curve.position.begin() + std::ptrdiff_t(first)));
	EXPECT_TRUE(std::equal(alone.radius.begin(), alone.radius.end(),
		result.curve.radius.begin() + std::ptrdiff_t(first)));

	// All vertices, of the input and of what was contracted, belong to a node of their own body.
	const auto isOfPlate = [](const Point3d& p) { return p[0] > 2; };
	ASSERT_EQ(result.node.size(), soup.points.size());
	for (size_t v = 0; v < soup.points.size(); ++v) {
		ASSERT_GE(result.node[v], 0);
		EXPECT_EQ(
			isOfPlate(soup.points[v]), isOfPlate(result.curve.position[size_t(result.node[v])]));
	}
	ASSERT_EQ(int(result.curve.node.size()), result.surface->vertexSlots());
	for (int v = 0; v < result.surface->vertexSlots(); ++v) {
		ASSERT_GE(result.curve.node[size_t(v)], 0);
		EXPECT_EQ(isOfPlate(result.surface->position[v]),
			isOfPlate(result.curve.position[size_t(result.curve.node[size_t(v)])]));
	}
}

TEST(Skeletonize, OfAttemptsWithinAttemptsOnlyTheStagesOfTheOneTakenAreSeen)
{
	// Curves only, without resampling, where both the sheets and the resampled surface are given up.
	std::vector<int> seen;
	Observer observer;
	observer.every = 1;
	observer.onStage = [&](const Stage& stage) { seen.push_back(stage.iteration); };
	observer.onStartOver = [&] { seen.clear(); };
	const auto made = [](int iteration) {
		Stage stage;
		stage.iteration = iteration;
		return stage;
	};
	observer.onStage(made(1));
	detail::Alternative curvesOnly(observer);
	const Observer outer = curvesOnly.listener();
	outer.onStage(made(2));
	outer.onStage(made(3));
	detail::Alternative asItIs(outer);
	const Observer inner = asItIs.listener();
	inner.onStage(made(4));
	asItIs.take();
	EXPECT_EQ(seen, std::vector<int>({1})) << "not yet taken";
	curvesOnly.take();
	EXPECT_EQ(seen, std::vector<int>({4}));
}

TEST(Skeletonize, SheetsThatWouldLeaveAThicketAreGivenUp)
{
	constexpr double breadth = 1, depth = 1, thickness = 2.5e-4; // 0.018 % of the diagonal
	shapes::Soup soup = shapes::box(breadth, depth, thickness);
	for (int i = 0; i < 3; ++i)
		soup = shapes::subdivided(soup);
	for (bool resample : {true, false}) {
		Parameters parameters;
		parameters.keepSheets = true;
		parameters.resample = resample;
		const Skeletonization result = run(soup, parameters);
		const MesoSkeleton skeleton =
			(result.sheets ? *result.sheets : withoutSheets(result.curve)).skeleton;
		EXPECT_LT(skeleton.curveLength(), 3 * std::hypot(breadth, depth)) << resample;
		const BettiNumbers b = skeleton.betti();
		EXPECT_EQ((std::vector<int> {b.b0, b.b1, b.b2}), (std::vector<int> {1, 0, 0})) << resample;
		EXPECT_EQ(result.node.size(), soup.points.size());
	}
}

TEST(Skeletonize, SheetsStandForCurves)
{
	// A block with a slit. Were its sheets kept, 60 % more curves would be left than without sheets.
	constexpr double slit = 1e-4;
	const double x[] = {0, 1, 1 + slit, 2 + slit}, z[] = {0, 0.6, 2};
	const shapes::Soup soup = shapes::subdivided(shapes::transformed(
		shapes::cells(3, 1, 2, [](int i, int, int k) { return i != 1 || k == 0; }),
		[&](const Point3d& p) { return Point3d(x[int(p[0])], p[1], z[int(p[2])]); }));
	Parameters parameters;
	parameters.resample = false;
	parameters.refine = false;
	const double curves = statistics(run(soup, parameters).curve).length;
	parameters.keepSheets = true;
	const Skeletonization result = run(soup, parameters);
	ASSERT_TRUE(result.sheets);
	EXPECT_LT(result.sheets->skeleton.curveLength(), 1.25 * curves);
}

TEST(Skeletonize, WhatIsContractedAsItIsMustNotLoseLimbs)
{
	const SurfaceMesh tube = shapes::capsule(10, 0.1, 12).mesh();
	const auto straight = [](double from, double to) {
		CurveSkeleton curve;
		curve.position = {{from, 0, 0}, {to, 0, 0}};
		curve.edges = {{0, 1}};
		curve.radius.assign(2, 0.1);
		return curve;
	};
	Skeletonization asItIs, resampled;
	asItIs.poles = std::make_shared<const PoleSet>(medialPoles(tube, PoleMethod::Balls));
	asItIs.refined = 1;
	resampled.curve = straight(-5, 5);
	asItIs.curve = straight(-5, 2);
	EXPECT_NEAR(detail::partLeftOut(tube, *asItIs.poles, resampled.curve, Progress()), 0, 1e-9);
	EXPECT_NEAR(detail::partLeftOut(tube, *asItIs.poles, asItIs.curve, Progress()), 0.3, 0.05);
	EXPECT_FALSE(detail::isBetter(tube, asItIs, resampled, Progress()));
	resampled.refinement.nodesOutside = 1;
	EXPECT_TRUE(detail::isBetter(tube, asItIs, resampled, Progress())) << "half is outside";
	resampled.refinement.nodesOutside = 0;
	asItIs.curve = straight(-5, 4.9);
	EXPECT_TRUE(detail::isBetter(tube, asItIs, resampled, Progress())) << "as much is described";
}

TEST(Skeletonize, ThePapersPresetIsFig4AndNothingElse)
{
	const shapes::Soup soup = shapes::fromFile("animal450");
	Parameters parameters = coarse();
	parameters.apply(Preset::Paper);
	if (!hasQhull) {
		EXPECT_THROW(run(soup, parameters), InvalidParameter);
		return;
	}
	const SurfaceMesh input =
		checkedSurface(roundedCoordinates(soup.points, soup.triangles), soup.triangles).mesh;
	const SurfaceMesh surface = resampledSurface(input, parameters).mesh;
	Stage stage = initialStage(surface, medialPoles(surface, PoleMethod::Voronoi)); // every vertex
	while (!stage.converged)
		stage = step(stage, parameters);
	const Skeletonization result = run(soup, parameters);
	expectSame(result.curve, collapseToCurve(stage, parameters.epsilon, Progress(), false));
	EXPECT_EQ(result.refined, 0);
	EXPECT_EQ(statistics(result.curve).components, 1);
	EXPECT_EQ(statistics(result.curve).cycles, 0);
	EXPECT_TRUE(differ(result.curve, run(soup, coarse()).curve));
}

TEST(Skeletonize, ACrowdSharesTheWorkAndSaysSo)
{
	constexpr int count = 72;
	shapes::Soup few, crowd;
	for (int i = 0; i < count; ++i) {
		crowd = shapes::joined(
			{crowd, shapes::moved(shapes::box(3, 1, 1), {5.0 * (i % 9), 3.0 * (i / 9), 0})});
		if (i == 20)
			few = crowd;
	}
	Observer observer;
	std::string log;
	observer.onNote = [&](const std::string& text) { log += text + "\n"; };
	const Skeletonization shared =
		skeletonize(crowd.points, crowd.triangles, Parameters(), Progress(), observer);
	EXPECT_NEAR(shared.stage->epsilon, 0.002 * std::sqrt(count / 50.0), 1e-12);
	EXPECT_NE(log.find("72 components: epsilon is 0.24 %"), std::string::npos) << log;
	EXPECT_EQ(statistics(shared.curve).components, count);
	EXPECT_EQ(statistics(shared.curve).cycles, 0);
	EXPECT_EQ(shared.refined, 1);

	const SurfaceMesh surface = resampledSurface(
		checkedSurface(roundedCoordinates(crowd.points, crowd.triangles), crowd.triangles).mesh,
		Parameters())
									.mesh;
	Stage stage =
		startOfFlow(surface, medialPoles(surface, Parameters().poleMethod), {}, Parameters());
	while (!stage.converged)
		stage = step(stage, Parameters());
	EXPECT_EQ(surface.position, shared.surface->position) << "stage by stage";
	EXPECT_EQ(stage.mesh.position, shared.stage->mesh.position) << "stage by stage";
	EXPECT_EQ(stage.epsilon, shared.stage->epsilon);

	Parameters chosen;
	chosen.epsilon = 0.003;
	EXPECT_EQ(skeletonize(crowd.points, crowd.triangles, chosen).stage->epsilon, 0.003);
	EXPECT_EQ(skeletonize(few.points, few.triangles).stage->epsilon, 0.002);
}

TEST(Skeletonize, DoesNotEndWhereWallsHavePassedEachOther)
{
	// The walls of a box go to its middle, and through each other, in the first steps: its volume is gone, and
	// its area stands still for one of them.
	const Skeletonization result = run(shapes::fromFile("cuboid"), Parameters());
	EXPECT_TRUE(result.stage->converged);
	EXPECT_LT(result.stage->areaFraction(), 0.05);
	EXPECT_GT(result.stage->fixedFraction(), 0.5);
}
