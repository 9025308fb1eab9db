// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "graphs.h"
#include "shapes.h"

#include <skeleton/io/skeleton_ply.h>
#include <skeleton/io/stage_ply.h>
#include <skeleton/poles/poles.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <tuple>

using namespace graphs;

namespace {

Stage startOf(const SurfaceMesh& mesh)
{
	return initialStage(mesh, medialPoles(mesh, PoleMethod::Balls));
}

/// Whether two arrays hold the same bytes: -0 differs from 0, and NaN is the same as itself.
template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b)
{
	return a.size() == b.size()
		&& (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// The first thing that is not the same in two stages; empty if they are the same to the last bit.
std::string difference(const Stage& a, const Stage& b)
{
	if (!sameBits(a.mesh.position, b.mesh.position))
		return "position";
	if (a.mesh.triangles() != b.mesh.triangles())
		return "triangles";
	for (int h = 0; h < a.mesh.halfEdgeSlots(); ++h)
		if (a.mesh.twin(h) != b.mesh.twin(h))
			return "twin";
	for (int v = 0; v < a.mesh.vertexSlots(); ++v)
		if (a.mesh.outgoing(v) != b.mesh.outgoing(v))
			return "outgoing";
	if (!sameBits(a.pole, b.pole) || !sameBits(a.poleRadius, b.poleRadius))
		return "pole";
	if (a.fixed != b.fixed || a.held != b.held || a.sheet != b.sheet)
		return "fixed";
	if (a.component != b.component)
		return "component";
	if (!sameBits(a.diagonal, b.diagonal) || !sameBits(a.initialArea, b.initialArea)
		|| !sameBits(a.area, b.area))
		return "components' measures";
	if (a.initialVolume != b.initialVolume || a.volume != b.volume)
		return "volume";
	if (!sameBits(*a.surface, *b.surface) || a.node != b.node)
		return "correspondence";
	if (a.iteration != b.iteration || a.converged != b.converged || a.epsilon != b.epsilon)
		return "iteration";
	return "";
}

std::string fileOf(const Stage& stage, const std::vector<int>& vertexOfSlot = {})
{
	return written([&](std::ostream& out) { writeStagePly(out, {stage, 0, vertexOfSlot}); });
}

StageFile readStage(const std::string& file)
{
	std::istringstream in(file);
	return readStagePly(readBinaryPly(in));
}

/// The text of the FormatError that reading a stage throws; empty if it throws none.
std::string refusal(const std::string& file)
{
	try {
		readStage(file);
	}
	catch (const FormatError& error) {
		return error.what();
	}
	return "";
}

/// A stage of a small torus after a few steps.
const Stage& smallStage()
{
	static const Stage stage = [] {
		Stage s = startOf(shapes::torus(1, 0.3, 24, 10).mesh());
		for (int i = 0; i < 3; ++i)
			s = step(std::move(s), Parameters());
		return s;
	}();
	return stage;
}

/// The file of a small stage with something changed in its tables.
std::string changed(const std::function<void(PlyFile&)>& change)
{
	std::istringstream in(fileOf(smallStage(), {0, 1, 2}));
	PlyFile ply = readBinaryPly(in);
	// In double, any value can be written anywhere.
	for (PlyElement& element : ply.elements)
		for (PlyColumn& column : element.columns)
			column.type = PlyType::Double;
	change(ply);
	return written([&](std::ostream& out) { writeBinaryPly(out, ply); });
}

} // namespace

TEST(StagePly, EveryStageReadsBackToTheLastBitAndStepsOnTheSame)
{
	const std::vector<shapes::Soup> surfaces = {shapes::torus(1, 0.3, 40, 14),
		shapes::joined({shapes::capsule(), shapes::moved(shapes::sphere(2), {9, 0, 0})}),
		shapes::scaled(shapes::capsule(2, 0.35, 16), 1e-6)};
	for (const shapes::Soup& surface : surfaces) {
		Stage stage = startOf(surface.mesh());
		for (int i = 0; i < 60 && !stage.converged; ++i) {
			const Stage read = readStage(fileOf(stage)).stage;
			ASSERT_EQ(difference(read, stage), "") << "after " << stage.iteration << " iterations";
			const Stage next = step(stage, Parameters());
			ASSERT_EQ(difference(step(read, Parameters()), next), "");
			stage = next;
		}
		EXPECT_TRUE(stage.converged);
		EXPECT_EQ(difference(readStage(fileOf(stage)).stage, stage), "");
	}
}

TEST(StagePly, KeepsWhatIsHeldAndWhatIsASheet)
{
	Stage stage = startOf(shapes::torus(1, 0.3, 24, 10).mesh());
	for (size_t v = 0; v < stage.held.size(); v += 7)
		stage.held[v] = stage.fixed[v] = 1;
	for (size_t v = 0; v < stage.sheet.size(); v += 3)
		stage.sheet[v] = 1;
	stage.epsilon = 0.0123;
	EXPECT_EQ(difference(readStage(fileOf(stage)).stage, stage), "");
}

TEST(StagePly, KeepsHowSmallEpsilonMustBeWhereTheShapeIsThin)
{
	Stage stage = startOf(shapes::torus(1, 0.3, 24, 10).mesh());
	ASSERT_TRUE(stage.epsilonLimit.empty());
	EXPECT_TRUE(readStage(fileOf(stage)).stage.epsilonLimit.empty());
	for (size_t v = 0; v < stage.pole.size(); ++v)
		stage.epsilonLimit.push_back(v % 2 ? 0.1 : 0.001 * (1 + double(v % 7)));
	EXPECT_EQ(readStage(fileOf(stage)).stage.epsilonLimit, stage.epsilonLimit);
	EXPECT_EQ(difference(readStage(fileOf(stage)).stage, stage), "");
}

TEST(StagePly, KeepsTheWayBackToTheSurfaceLayer)
{
	const std::vector<int> slots = {0, -1, 2, 239};
	const std::uint64_t fingerprint = 0xFEDCBA9876543210;
	const StageFile read = readStage(written([&](std::ostream& out) {
		writeStagePly(out, {smallStage(), fingerprint, slots});
	}));
	EXPECT_EQ(read.surfaceFingerprint, fingerprint);
	EXPECT_EQ(read.vertexOfSlot, slots);
}

TEST(StagePly, ErrorsSayWhere)
{
	const std::string file = fileOf(smallStage());
	EXPECT_NE(refusal("solid cube").find("Line 1"), std::string::npos);
	EXPECT_NE(refusal(file.substr(0, 60)).find("Line"), std::string::npos) << "within the header";
	EXPECT_NE(refusal(file.substr(0, file.size() - 1)).find("Byte"), std::string::npos);
	EXPECT_NE(refusal(file + 'x').find("1 bytes too many"), std::string::npos);

	const auto replaced = [&](const std::string& what, const std::string& by) {
		std::string copy = file;
		const size_t at = copy.find(what);
		EXPECT_NE(at, copy.npos);
		return copy.replace(at, what.size(), by);
	};
	EXPECT_NE(refusal(replaced("mcfskel stage 1", "mcfskel stage 9")).find("Save Stage"),
		std::string::npos);
	EXPECT_NE(refusal(replaced("binary_little_endian", "ascii")).find("Line 2"), std::string::npos);
	EXPECT_NE(refusal(replaced("double mcfskel_radius", "dubble mcfskel_radius")).find("Line"),
		std::string::npos);
	EXPECT_NE(
		refusal(replaced("mcfskel_pole_radius", "mcfskel_lost_radius")).find("mcfskel_pole_radius"),
		std::string::npos);
}

TEST(StagePly, RefusesValuesThatCannotBe)
{
	const auto with = [](const std::string& element, const std::string& column, size_t row,
						  double value) {
		return refusal(changed([&](PlyFile& ply) {
			for (PlyElement& e : ply.elements)
				for (PlyColumn& c : e.columns)
					if (e.name == element && c.name == column)
						c.values.at(row) = value;
		}));
	};
	EXPECT_EQ(refusal(changed([](PlyFile&) {})), "");
	for (const auto& [element, column, row, value] :
		std::vector<std::tuple<std::string, std::string, size_t, double>> {
			{"vertex", "x", 5, std::nan("")},
			{"vertex", "mcfskel_pole_radius", 7, INFINITY},
			{"vertex", "mcfskel_pole_z", 2, -INFINITY},
			{"vertex", "mcfskel_component", 3, 1},
			{"vertex", "mcfskel_component", 3, -1},
			{"vertex", "mcfskel_fixed", 4, 2},
			{"vertex", "mcfskel_held", 4, 2},
			{"vertex", "mcfskel_sheet", 4, -1},
			{"mcfskel_stage", "epsilon", 0, -1},
			{"vertex", "z", 5, 1e228},
			{"vertex", "x", 5, 1000},
			{"vertex", "mcfskel_pole_x", 1, -1e228},
			{"vertex", "mcfskel_pole_x", 1, 1000},
			{"vertex", "mcfskel_pole_radius", 7, 1e100},
			{"mcfskel_surface", "node", 2, 1 << 30},
			{"mcfskel_surface", "node", 2, -1},
			{"mcfskel_surface", "x", 3, 1e228},
			{"mcfskel_slot", "vertex", 1, -2},
			{"mcfskel_slot", "vertex", 1, 240},
			{"mcfskel_surface", "y", 6, std::nan("")},
			{"mcfskel_component", "initial_area", 0, 0},
			{"mcfskel_component", "initial_area", 0, std::nan("")},
			{"mcfskel_component", "area", 0, -1},
			{"mcfskel_component", "diagonal", 0, -1},
			{"mcfskel_component", "diagonal", 0, 1e-300},
			{"mcfskel_component", "diagonal", 0, 1e3},
			{"mcfskel_component", "diagonal", 0, 1e-3},
			{"mcfskel_stage", "iteration", 0, -1},
			{"mcfskel_stage", "iteration", 0, 2147483647},
			{"mcfskel_stage", "epsilon", 0, 0},
			{"mcfskel_stage", "epsilon", 0, 0.11},
			{"mcfskel_stage", "epsilon", 0, std::nan("")},
			{"mcfskel_stage", "initial_volume", 0, 0},
			{"mcfskel_stage", "initial_volume", 0, -1},
			{"mcfskel_stage", "initial_volume", 0, 1e-310},
			{"mcfskel_stage", "volume", 0, std::nan("")},
			{"mcfskel_stage", "volume", 0, 1e308},
			{"mcfskel_stage", "fingerprint_low", 0, 4294967296.0},
			{"mcfskel_stage", "converged", 0, 7},
		})
		EXPECT_NE(with(element, column, row, value)
					  .find("Element '" + element + "', row " + std::to_string(row)),
			std::string::npos)
			<< column;
}

TEST(StagePly, SaysHowManyRowsAreWrong)
{
	const std::string text = refusal(changed([](PlyFile& ply) {
		for (PlyElement& element : ply.elements)
			if (element.name == "vertex")
				for (size_t row : {9, 4, 7})
					element.columns[0].values[row] = std::nan("");
	}));
	EXPECT_NE(text.find("row 4"), text.npos) << text;
	EXPECT_NE(text.find("3 such rows"), text.npos) << text;
}

TEST(StagePly, WritesNothingThatItWouldNotRead)
{
	Stage stage = smallStage();
	stage.node[3] = -1;
	EXPECT_THROW(fileOf(stage), InvalidStage);
}

TEST(StagePly, RefusesMeshesThatAreNoClosedManifold)
{
	const auto refused = [](const std::function<void(PlyElement&)>& change) {
		return refusal(changed([&](PlyFile& ply) {
			for (PlyElement& element : ply.elements)
				if (element.name == "face")
					change(element);
		}));
	};
	EXPECT_NE(refused([](PlyElement& face) {
		face.rows -= 1;
		face.columns[0].values.resize(3 * face.rows);
	}).find("not closed"),
		std::string::npos);
	EXPECT_NE(refused([](PlyElement& face) {
		std::swap(face.columns[0].values[0], face.columns[0].values[1]);
	}),
		"");
	EXPECT_NE(refused([](PlyElement& face) {
		face.columns[0].values[4] = face.columns[0].values[3];
	}).find("row 1"),
		std::string::npos);
	EXPECT_NE(refused([](PlyElement& face) { face.columns[0].values[0] = 1e6; }).find("row 0"),
		std::string::npos);
}

TEST(StagePly, DamagedFilesAreReadOrRefused)
{
	int refusals = 0;
	readDamaged(fileOf(smallStage()), 2000, [&](std::istream& in) {
		try {
			const Stage stage = readStagePly(readBinaryPly(in)).stage;
			EXPECT_EQ(stage.mesh.eulerCharacteristic() % 2, 0);
			EXPECT_NO_THROW(checkStage(step(stage, Parameters())));
		}
		catch (const FormatError&) {
			++refusals;
		}
		catch (const SolverError&) {
		}
	});
	EXPECT_GT(refusals, 600);
}

TEST(SkeletonPly, ReadsBackToTheLastBit)
{
	CurveSkeleton s = ringWithTailAndY();
	s.significance = {1, 1, 1, 1, 1, 1.0 / 3, 1.0 / 3, 1, 0.7, 1, 1};
	std::istringstream in(written([&](std::ostream& out) { writeSkeletonPly(out, s); }));
	const SkeletonFile file = readSkeletonPly(readBinaryPly(in));
	EXPECT_TRUE(sameBits(file.skeleton.significance, s.significance));
	EXPECT_TRUE(sameBits(file.skeleton.position, s.position));
	EXPECT_TRUE(sameBits(file.skeleton.radius, s.radius));
	EXPECT_EQ(file.skeleton.edges, s.edges);
	EXPECT_EQ(file.skeleton.node, s.node);
}

TEST(SkeletonPly, RefusesValuesThatCannotBe)
{
	const auto with = [](const std::string& element, const std::string& column, double value) {
		CurveSkeleton skeleton = ringWithTailAndY();
		skeleton.significance.assign(skeleton.position.size(), 1);
		std::istringstream in(written([&](std::ostream& out) { writeSkeletonPly(out, skeleton); }));
		PlyFile ply = readBinaryPly(in);
		for (PlyElement& e : ply.elements)
			for (PlyColumn& c : e.columns)
				if (e.name == element && c.name == column)
					c.values.at(2) = value;
		try {
			readSkeletonPly(ply);
		}
		catch (const FormatError& error) {
			return std::string(error.what());
		}
		return std::string();
	};
	EXPECT_EQ(with("vertex", "mcfskel_radius", 0), "");
	for (double value : {-1.0, -1e-300, double(NAN), double(INFINITY), 1e37})
		EXPECT_NE(with("vertex", "mcfskel_radius", value).find("row 2: 'mcfskel_radius' is"),
			std::string::npos)
			<< value;
	EXPECT_EQ(with("vertex", "mcfskel_significance", 0), "");
	for (double value : {-1e-300, 1.1, double(NAN), double(INFINITY)})
		EXPECT_NE(
			with("vertex", "mcfskel_significance", value).find("row 2: 'mcfskel_significance' is"),
			std::string::npos)
			<< value;
	for (double value : {1e37, -1e228, double(NAN), -double(INFINITY)})
		EXPECT_NE(with("vertex", "y", value).find("row 2"), std::string::npos) << value;
	for (double value : {-1.0, 11.0, 0.5})
		EXPECT_NE(with("edge", "vertex1", value).find("row 2"), std::string::npos) << value;
	for (double value : {-2.0, 11.0})
		EXPECT_NE(with("mcfskel_surface", "node", value).find("row 2"), std::string::npos) << value;
}

TEST(SkeletonPly, DamagedFilesAreReadOrRefused)
{
	const std::string file =
		written([](std::ostream& out) { writeSkeletonPly(out, ringWithTailAndY()); });
	readDamaged(file, 3000, [](std::istream& in) {
		try {
			const CurveSkeleton s = readSkeletonPly(readBinaryPly(in)).skeleton;
			EXPECT_NO_THROW(requireWritable(s));
		}
		catch (const FormatError&) {
		}
	});
}

TEST(BinaryPly, HeadersOfManyNamesAreReadInTime)
{
	std::string header = "ply\nformat binary_little_endian 1.0\n";
	for (int e = 0; e < 30000; ++e)
		header += "element e" + std::to_string(e) + " 0\n";
	for (int c = 0; c < 30000; ++c)
		header += "property double c" + std::to_string(c) + "\n";
	std::istringstream in(header + "end_header\n");
	EXPECT_EQ(readBinaryPly(in).elements.size(), 30000u);
	std::istringstream twice(header + "property double c0\nend_header\n");
	EXPECT_EQ(errorLine([&](std::istream& file) { readBinaryPly(file); }, twice.str()), 60003u);
}

TEST(BinaryPly, HugeCountsDoNotTakeMemory)
{
	std::istringstream in(
		"ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nproperty double x\nend_header\n");
	EXPECT_THROW(readBinaryPly(in), FormatError);
	std::istringstream none(
		"ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nend_header\n");
	EXPECT_THROW(readBinaryPly(none), FormatError);
}
