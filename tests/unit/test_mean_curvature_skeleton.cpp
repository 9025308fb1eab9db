// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "read_off.h"
#include "shapes.h"

#include <skeleton/mean_curvature_skeleton.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace vcg::tri;
using vcg::Point3d;

namespace {

// VCG leaves a mesh's attributes to whoever made them; the skeletonization's stay for the caller to read.
template <class... Containers>
class OwningMesh : public TriMesh<Containers...>
{
public:
	~OwningMesh() override { this->ClearAttributes(); }
};

// A mesh in float with all that is needed and no more, one in double with more than that.

class LeanVertex;
class LeanFace;
struct LeanTypes
		: vcg::UsedTypes<vcg::Use<LeanVertex>::AsVertexType, vcg::Use<LeanFace>::AsFaceType>
{
};
class LeanVertex : public vcg::Vertex<LeanTypes, vcg::vertex::Coord3f, vcg::vertex::BitFlags>
{
};
class LeanFace : public vcg::Face<LeanTypes, vcg::face::VertexRef, vcg::face::BitFlags>
{
};
class FloatMesh : public OwningMesh<std::vector<LeanVertex>, std::vector<LeanFace>>
{
};

class NodeVertex;
class CurveEdge;
struct CurveTypes
		: vcg::UsedTypes<vcg::Use<NodeVertex>::AsVertexType, vcg::Use<CurveEdge>::AsEdgeType>
{
};
class NodeVertex : public vcg::Vertex<CurveTypes, vcg::vertex::Coord3f, vcg::vertex::BitFlags>
{
};
class CurveEdge : public vcg::Edge<CurveTypes, vcg::edge::VertexRef>
{
};
class FloatCurve : public OwningMesh<std::vector<NodeVertex>, std::vector<CurveEdge>>
{
};

class RichVertex;
class RichEdge;
class RichFace;
struct RichTypes : vcg::UsedTypes<vcg::Use<RichVertex>::AsVertexType,
					   vcg::Use<RichEdge>::AsEdgeType, vcg::Use<RichFace>::AsFaceType>
{
};
class RichVertex : public vcg::Vertex<RichTypes, vcg::vertex::Coord3d, vcg::vertex::Normal3d,
					   vcg::vertex::Qualityd, vcg::vertex::VFAdj, vcg::vertex::BitFlags>
{
};
class RichEdge : public vcg::Edge<RichTypes, vcg::edge::VertexRef, vcg::edge::BitFlags>
{
};
class RichFace
		: public vcg::Face<RichTypes, vcg::face::VertexRef, vcg::face::FFAdj, vcg::face::BitFlags>
{
};
class DoubleMesh
		: public OwningMesh<std::vector<RichVertex>, std::vector<RichEdge>, std::vector<RichFace>>
{
};

template <class MeshType>
void fill(MeshType& mesh, const shapes::Soup& soup)
{
	mcf::fillMesh(mesh, soup.points, {}, soup.triangles);
}

template <class MeshType>
typename MeanCurvatureSkeleton<MeshType>::Params coarse()
{
	typename MeanCurvatureSkeleton<MeshType>::Params params;
	params.target_length = 0.03;
	return params;
}

template <class MeshType>
std::vector<Point3d> places(const MeshType& mesh)
{
	std::vector<Point3d> result;
	for (const auto& v : mesh.vert)
		result.push_back(Point3d::Construct(v.cP()));
	return result;
}

template <class MeshType>
std::vector<std::array<int, 2>> edges(const MeshType& mesh)
{
	std::vector<std::array<int, 2>> result;
	for (const auto& e : mesh.edge)
		result.push_back({int(Index(mesh, e.cV(0))), int(Index(mesh, e.cV(1)))});
	return result;
}

template <class MeshType>
std::vector<double> scalars(MeshType& mesh, const char* name)
{
	using Scalar = typename MeshType::ScalarType;
	auto attribute = Allocator<MeshType>::template FindPerVertexAttribute<Scalar>(mesh, name);
	std::vector<double> result;
	if (Allocator<MeshType>::IsValidHandle(mesh, attribute))
		for (size_t v = 0; v < mesh.vert.size(); ++v)
			result.push_back(attribute[v]);
	return result;
}

mcf::Skeletonization expectedOf(const shapes::Soup& soup)
{
	mcf::Parameters parameters;
	parameters.targetLength = 0.03;
	return mcf::skeletonize(soup.points, soup.triangles, parameters);
}

std::vector<double> asDoubles(const std::vector<int>& values)
{
	return std::vector<double>(values.begin(), values.end());
}

} // namespace

TEST(MeanCurvatureSkeleton, DoGivesTheBitsOfTheLibrary)
{
	const shapes::Soup soup = shapes::fromFile("letter_p");
	DoubleMesh mesh, skeleton;
	fill(mesh, soup);
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, coarse<DoubleMesh>());
	const mcf::Skeletonization expected = expectedOf(soup);
	EXPECT_EQ(places(skeleton), expected.curve.position);
	EXPECT_EQ(edges(skeleton), expected.curve.edges);
	EXPECT_EQ(scalars(skeleton, "mcfskel_radius"), expected.curve.radius);
	EXPECT_EQ(scalars(skeleton, "mcfskel_significance"), expected.curve.significance);
	for (size_t v = 0; v < skeleton.vert.size(); ++v)
		EXPECT_EQ(skeleton.vert[v].Q(), expected.curve.radius[v]);
	EXPECT_EQ(scalars(mesh, "mcfskel_node"), asDoubles(expected.node));
	EXPECT_EQ(places(mesh), soup.points);
	EXPECT_EQ(mesh.FN(), int(soup.triangles.size()));
}

TEST(MeanCurvatureSkeleton, FloatMeshesGiveTheSameRoundedToFloat)
{
	const shapes::Soup soup = shapes::fromFile("letter_p");
	FloatMesh mesh;
	fill(mesh, soup);
	FloatCurve skeleton; // no faces, no quality
	MeanCurvatureSkeleton<FloatMesh>::Do(mesh, skeleton, coarse<FloatMesh>());
	const mcf::Skeletonization expected = expectedOf(soup);
	ASSERT_EQ(skeleton.vert.size(), expected.curve.position.size());
	EXPECT_EQ(edges(skeleton), expected.curve.edges);
	for (size_t v = 0; v < skeleton.vert.size(); ++v)
		EXPECT_EQ(skeleton.vert[v].P(), vcg::Point3f::Construct(expected.curve.position[v]));
	const std::vector<double> radius = scalars(skeleton, "mcfskel_radius");
	for (size_t v = 0; v < radius.size(); ++v)
		EXPECT_EQ(radius[v], double(float(expected.curve.radius[v])));
	EXPECT_EQ(scalars(mesh, "mcfskel_node"), asDoubles(expected.node));
}

TEST(MeanCurvatureSkeleton, DeletedElementsDoNotCount)
{
	const shapes::Soup soup = shapes::capsule();
	const mcf::Skeletonization expected = expectedOf(soup);
	DoubleMesh mesh, skeleton;
	fill(mesh, shapes::joined({shapes::scaled(shapes::box(), 5), soup}));
	const int boxVertices = 8, boxFaces = 12;
	for (int f = 0; f < boxFaces; ++f)
		Allocator<DoubleMesh>::DeleteFace(mesh, mesh.face[size_t(f)]);
	for (int v = 0; v < boxVertices; ++v)
		Allocator<DoubleMesh>::DeleteVertex(mesh, mesh.vert[size_t(v)]);
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, coarse<DoubleMesh>());
	EXPECT_EQ(places(skeleton), expected.curve.position);
	std::vector<double> node = scalars(mesh, "mcfskel_node");
	node.erase(node.begin(), node.begin() + boxVertices);
	EXPECT_EQ(node, asDoubles(expected.node));
	EXPECT_EQ(mesh.VN(), int(soup.points.size()));
}

TEST(MeanCurvatureSkeleton, StageByStageIsTheSame)
{
	const shapes::Soup soup = shapes::fromFile("animal450");
	DoubleMesh mesh, skeleton, stage, resampled, bySteps;
	fill(mesh, soup);
	auto params = coarse<DoubleMesh>();
	params.keep_stages = 2;
	std::vector<std::vector<Point3d>> kept;
	params.on_stage = [&](const DoubleMesh& stage, int iteration) {
		EXPECT_EQ(iteration, 2 * int(kept.size() + 1));
		kept.push_back(places(stage));
	};
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
	const std::vector<double> node = scalars(mesh, "mcfskel_node");
	EXPECT_GE(kept.size(), 3u);

	const DoubleMesh& untouched = mesh;
	MeanCurvatureSkeleton<DoubleMesh> run(untouched, params);
	run.Resample();
	run.GetSurface(resampled);
	run.ComputePoles();
	EXPECT_EQ(run.Poles().radius.size(), resampled.vert.size());
	size_t seen = 0;
	for (bool more = true; more;) {
		more = run.Step();
		const int iteration = run.Figures().iteration;
		if (iteration % 2 == 0 && seen < kept.size()) {
			run.GetStage(stage);
			EXPECT_EQ(places(stage), kept[seen++]);
		}
	}
	EXPECT_EQ(seen, kept.size());
	EXPECT_TRUE(run.Figures().converged);
	run.Collapse();
	run.Refine();
	run.GetSkeleton(bySteps);
	EXPECT_EQ(places(bySteps), places(skeleton));
	EXPECT_EQ(edges(bySteps), edges(skeleton));
	EXPECT_EQ(scalars(bySteps, "mcfskel_radius"), scalars(skeleton, "mcfskel_radius"));
	mcf::writeScalarAttribute(mesh, "mcfskel_node", [](size_t) { return -2; });
	run.WriteNodes(mesh);
	EXPECT_EQ(scalars(mesh, "mcfskel_node"), node);
}

TEST(MeanCurvatureSkeleton, StageByStageIsTheSameWhereResamplingCutsCornersOrIsTooCoarse)
{
	struct Case
	{
		shapes::Soup soup;
		double length;
		bool isTooThin;
	};
	// Legs of a radius of half an edge, and a plate of eight vertices, too few to resolve it.
	for (const Case& of : {Case {shapes::fromFile("animal450"), 0.06, false},
			 Case {shapes::box(1, 0.7, 0.01), 0.03, true}}) {
		mcf::Parameters parameters;
		parameters.targetLength = of.length;
		const mcf::ResampledSurface resampled = mcf::resampledSurface(of.soup.mesh(), parameters);
		ASSERT_EQ(resampled.isTooThin, of.isTooThin);
		DoubleMesh mesh, skeleton, bySteps;
		fill(mesh, of.soup);
		auto params = coarse<DoubleMesh>();
		params.target_length = of.length;
		MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
		const std::vector<double> node = scalars(mesh, "mcfskel_node");
		MeanCurvatureSkeleton<DoubleMesh> run(mesh, params);
		run.Resample();
		while (run.Step())
			;
		run.Collapse();
		run.Refine();
		run.GetSkeleton(bySteps);
		run.WriteNodes(mesh);
		EXPECT_EQ(places(bySteps), places(skeleton));
		EXPECT_EQ(edges(bySteps), edges(skeleton));
		for (const char* name : {"mcfskel_radius", "mcfskel_significance"})
			EXPECT_EQ(scalars(bySteps, name), scalars(skeleton, name));
		EXPECT_EQ(scalars(mesh, "mcfskel_node"), node);
		const mcf::SolidTest solid(of.soup.points, of.soup.triangles);
		for (const Point3d& p : places(bySteps))
			EXPECT_TRUE(solid.isInside(solid.in(p)));
	}
}

TEST(MeanCurvatureSkeleton, KeepsSheetsAsFaces)
{
	DoubleMesh mesh, skeleton;
	fill(mesh, shapes::transformed(shapes::plate(0, 12), [](const Point3d& p) {
		return Point3d(p[0], p[1], p[2] / 8);
	}));
	auto params = coarse<DoubleMesh>();
	params.keep_sheets = true;
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
	EXPECT_GT(skeleton.FN(), 10);
	MeanCurvatureSkeleton<DoubleMesh> run(mesh, params);
	run.Resample();
	while (run.Step()) {
	}
	run.Collapse();
	DoubleMesh bySteps;
	run.GetSkeleton(bySteps);
	EXPECT_EQ(places(bySteps), places(skeleton));
	EXPECT_EQ(bySteps.FN(), skeleton.FN());
	EXPECT_THROW(run.Refine(), mcf::InvalidInput);

	FloatCurve withoutFaces;
	EXPECT_THROW(
		MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, withoutFaces, params), mcf::InvalidInput);
	FloatMesh withoutEdges;
	EXPECT_THROW(MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, withoutEdges), mcf::InvalidInput);
}

TEST(MeanCurvatureSkeleton, HoldsSelectedVertices)
{
	const shapes::Soup soup = shapes::capsule();
	DoubleMesh mesh, skeleton;
	fill(mesh, soup);
	auto params = coarse<DoubleMesh>();
	params.resample = false;
	params.fix_selected = true;
	EXPECT_THROW(MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params), mcf::InvalidInput);
	mesh.vert[7].SetS();
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
	const int node = int(scalars(mesh, "mcfskel_node")[7]);
	// In single precision, as the surface is read.
	EXPECT_EQ(vcg::Point3f::Construct(skeleton.vert[size_t(node)].P()),
		vcg::Point3f::Construct(soup.points[7]));
}

namespace {

int reportsLeft = 0;

bool cancelLater(int, const char*)
{
	return --reportsLeft > 0;
}

} // namespace

TEST(MeanCurvatureSkeleton, CancelledOrRefusedLeavesBothMeshesAsTheyWere)
{
	DoubleMesh mesh, skeleton, open;
	const shapes::Soup soup = shapes::capsule(), before = shapes::tetrahedron();
	fill(mesh, soup);
	fill(skeleton, before);
	const auto unchanged = [&] {
		return places(mesh) == soup.points && places(skeleton) == before.points
			&& skeleton.FN() == 4 && mesh.vert_attr.empty() && skeleton.vert_attr.empty();
	};
	for (int reports : {1, 10, 100, 400}) {
		reportsLeft = reports;
		EXPECT_THROW(MeanCurvatureSkeleton<DoubleMesh>::Do(
						 mesh, skeleton, coarse<DoubleMesh>(), cancelLater),
			mcf::Cancelled);
		EXPECT_TRUE(unchanged());
	}
	fill(open, shapes::opened(soup));
	auto params = coarse<DoubleMesh>();
	params.repair = mcf::Repair::Off;
	EXPECT_THROW(MeanCurvatureSkeleton<DoubleMesh>::Do(open, skeleton, params), mcf::InvalidInput);
	params = coarse<DoubleMesh>();
	params.w_l = 0;
	EXPECT_THROW(
		MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params), mcf::InvalidParameter);
	params = coarse<DoubleMesh>();
	params.keep_stages = -1;
	EXPECT_THROW(
		MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params), mcf::InvalidParameter);
	EXPECT_TRUE(unchanged());

	Allocator<DoubleMesh>::AddPerVertexAttribute<Point3d>(mesh, "mcfskel_node");
	EXPECT_THROW(MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton), mcf::InvalidInput);
}

TEST(MeanCurvatureSkeleton, MarksOfBridgesOfAnEarlierSkeletonGo)
{
	DoubleMesh mesh, skeleton;
	fill(mesh, shapes::joined({shapes::capsule(), shapes::moved(shapes::capsule(), {0, 0, 9})}));
	auto params = coarse<DoubleMesh>();
	params.join = true;
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
	EXPECT_TRUE(HasPerVertexAttribute(skeleton, "mcfskel_bridge"));
	params.join = false;
	MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, params);
	EXPECT_FALSE(HasPerVertexAttribute(skeleton, "mcfskel_bridge"));
}

TEST(MeanCurvatureSkeleton, AttributesOfAnotherTypeOnTheSkeletonAreRefused)
{
	DoubleMesh mesh;
	fill(mesh, shapes::capsule());
	MeanCurvatureSkeleton<DoubleMesh> run(mesh, coarse<DoubleMesh>());
	run.Resample();
	while (run.Step())
		;
	run.Collapse();
	for (const char* name : {"mcfskel_radius", "mcfskel_significance", "mcfskel_bridge"}) {
		DoubleMesh skeleton;
		fill(skeleton, shapes::tetrahedron());
		Allocator<DoubleMesh>::AddPerVertexAttribute<float>(skeleton, name);
		for (bool byStages : {false, true})
			try {
				if (byStages)
					run.GetSkeleton(skeleton);
				else
					MeanCurvatureSkeleton<DoubleMesh>::Do(mesh, skeleton, coarse<DoubleMesh>());
				ADD_FAILURE() << name << " was taken";
			}
			catch (const mcf::InvalidInput& error) {
				EXPECT_EQ(std::string(error.what()),
					std::string("The mesh has a vertex attribute ") + name + " of another type.");
			}
		EXPECT_EQ(places(skeleton), shapes::tetrahedron().points);
		EXPECT_TRUE(mesh.vert_attr.empty());
	}
}

TEST(MeanCurvatureSkeleton, StagesOutOfOrderAreRefused)
{
	DoubleMesh mesh, skeleton;
	fill(mesh, shapes::capsule());
	auto params = coarse<DoubleMesh>();
	params.max_iterations = 1;
	MeanCurvatureSkeleton<DoubleMesh> run(mesh, params);
	EXPECT_THROW(run.GetSkeleton(skeleton), mcf::InvalidInput);
	EXPECT_THROW(run.Refine(), mcf::InvalidInput);
	EXPECT_THROW(run.GetStage(skeleton), mcf::InvalidInput);
	EXPECT_THROW(run.Poles(), mcf::InvalidInput);
	EXPECT_FALSE(run.Step());
	EXPECT_FALSE(run.Step());
	EXPECT_EQ(run.Figures().iteration, 1);
	EXPECT_THROW(run.Resample(), mcf::InvalidInput);
	EXPECT_THROW(run.ComputePoles(), mcf::InvalidInput);
	run.Collapse();
	Allocator<DoubleMesh>::AddVertex(mesh, Point3d(0, 0, 0));
	EXPECT_THROW(run.WriteNodes(mesh), mcf::InvalidInput);
}

TEST(MeanCurvatureSkeleton, TakesThePresetOfThePaper)
{
	if (!mcf::hasQhull)
		return;
	const shapes::Soup soup = shapes::capsule();
	mcf::Parameters parameters;
	parameters.targetLength = 0.03;
	parameters.apply(mcf::Preset::Paper);
	const mcf::Skeletonization expected = mcf::skeletonize(soup.points, soup.triangles, parameters);
	DoubleMesh surface, skeleton, stepwise;
	fill(surface, soup);
	auto params = coarse<DoubleMesh>();
	params.preset = mcf::Preset::Paper;
	MeanCurvatureSkeleton<DoubleMesh>::Do(surface, skeleton, params);
	EXPECT_EQ(places(skeleton), expected.curve.position);
	MeanCurvatureSkeleton<DoubleMesh> run(surface, params);
	run.Resample();
	while (run.Step())
		;
	run.Collapse();
	run.GetSkeleton(stepwise);
	EXPECT_EQ(places(stepwise), expected.curve.position);
}
