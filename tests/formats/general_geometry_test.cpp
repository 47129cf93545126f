// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/general_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <numbers>

#include "exitance/scene/formats/contained_call.h"
#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;

// Coordinates, and most numbers, go through float.
constexpr double rounding = 1e-6;

bool warned(const Scene& scene, const std::string& words) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(), [&](const Problem& problem) {
        return problem.what.find(words) != std::string::npos;
    });
}

double total_area(const Scene& scene) {
    double sum = 0;
    for (const Polygon& polygon : scene.polygons) sum += scene.area(polygon);
    return sum;
}

void expect_vector(const Vec3& v, const Vec3& expected) {
    EXPECT_NEAR(v.x, expected.x, rounding);
    EXPECT_NEAR(v.y, expected.y, rounding);
    EXPECT_NEAR(v.z, expected.z, rounding);
}

void expect_bands(const Spectrum& s, double r, double g, double b) {
    ASSERT_EQ(s.size(), 3U);
    EXPECT_NEAR(s[0], r, rounding);
    EXPECT_NEAR(s[1], g, rounding);
    EXPECT_NEAR(s[2], b, rounding);
}

// One square of 1 m² of 'oak', 1 m along x and 0.5 m up, that faces up: y.
void expect_table(const Scene& scene) {
    ASSERT_GE(scene.polygons.size(), 1U);
    EXPECT_NEAR(total_area(scene), 1, rounding);
    expect_vector(scene.normal(scene.polygons[0]), {0, 1, 0});
    expect_vector(scene.bounds().lower, {1, 0.5, -1});
    expect_vector(scene.bounds().upper, {2, 0.5, 0});
    EXPECT_EQ(scene.materials.at(0).name, "oak");
    expect_bands(scene.materials[0].reflectance, 0.5, 0.25, 0.125);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(GeneralGeometry, ObjFacesNamesAndMaterials) {
    const Folder folder;
    folder.write("room.mtl",
                 "newmtl white\nKd 0.7 0.6 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 20 30\n"
                 "newmtl glass\nKd 0.5 0.5 0.5\nd 0.25\n");
    const Scene scene = read_scene(folder.write(
        "room.obj", "mtllib room.mtl\no floor\n" + square +
                        "v .5 .2 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nv 0 0 5\nvn 0 0 1\nusemtl white\n"
                        "f 1//1 2//1 3//1 4//1\no lamp\nusemtl lamp\nf 1 3 2\n"
                        "o pane\nusemtl glass\nf 9 6 5 7 8\n"));
    // A quad, a triangle, and a pentagon of 1 m² less a notch of 0.25 m², of three triangles.
    ASSERT_EQ(scene.polygons.size(), 5U);
    EXPECT_EQ(scene.polygons[0].size(), 4U);
    EXPECT_EQ(scene.normals[scene.polygons[0].corners[0]], Vec3(0, 0, 1));
    EXPECT_NEAR(total_area(scene), 1 + 0.5 + 0.75, rounding);
    ASSERT_EQ(scene.surfaces.size(), 3U);
    EXPECT_EQ(scene.surfaces[0].name, "floor");
    EXPECT_EQ(scene.surfaces[1].name, "lamp");
    EXPECT_EQ(scene.surfaces[2].name, "pane");
    expect_bands(scene.materials[0].reflectance, 0.7, 0.6, 0.5);
    EXPECT_TRUE(scene.materials[0].two_sided);
    expect_bands(scene.materials[1].exitance, 10, 20, 30);
    EXPECT_FALSE(scene.materials[1].two_sided);
    expect_bands(scene.materials[2].reflectance, 0.125, 0.125, 0.125);  // 0.25 · 0.5
    expect_bands(scene.materials[2].transmittance, 0.75, 0.75, 0.75);
    EXPECT_EQ(scene.quantity, Quantity::unitless);
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].what.find("metres"), std::string::npos);
}

TEST(GeneralGeometry, ObjMaterialsStayInTheFolder) {
    const Folder folder;
    const std::string rest = "\n" + square + "usemtl a\nf 1 2 3 4\n";
    folder.write("a.mtl", "newmtl a\nKd .3 .3 .3\n");
    const auto out = folder.write("in/out.obj", "mtllib ../a.mtl" + rest);
    expect_refused([&] { read_scene(out); }, out.string(), "inside the scene's folder");
    const Scene missing = read_scene(folder.write("in/missing.obj", "mtllib none.mtl" + rest));
    EXPECT_TRUE(warned(missing, "there is no file 'none.mtl'"));
    EXPECT_EQ(missing.polygons.size(), 1U);
}

TEST(GeneralGeometry, PlyAndStl) {
    const Folder folder;
    const Scene ply = read_scene(folder.write(
        "t.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
    EXPECT_EQ(ply.polygons.size(), 1U);
    EXPECT_NEAR(total_area(ply), 1, rounding);
    expect_bands(ply.materials.at(0).reflectance, 0.5, 0.5, 0.5);
    EXPECT_TRUE(warned(ply, "geometry without a material"));
    const Scene ascii = read_scene(folder.write(
        "t.STL",
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid t\n"));
    EXPECT_NEAR(total_area(ascii), 0.5, rounding);
    std::string bytes(80, 'x');
    const auto put = [&](const auto value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(std::uint32_t{1});
    for (const float f : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 2.F, 0.F, 0.F, 0.F, 2.F, 0.F}) put(f);
    put(std::uint16_t{0});
    const Scene binary = read_scene(folder.write("b.stl", bytes));
    EXPECT_NEAR(total_area(binary), 2, rounding);
}

TEST(GeneralGeometry, FbxUnitsAndAxes) {
    const Folder folder;
    const Scene scene = read_scene(folder.write("t.fbx", R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 100, "Geometry::quad", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,100,0,0,100,100,0,0,100,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
		}
	}
	Model: 200, "Model::table", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",100,0,50
		}
	}
	Material: 300, "Material::oak", "" {
		Version: 102
		ShadingModel: "phong"
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.5,0.25,0.125
		}
	}
}
Connections:  {
	C: "OO",200,0
	C: "OO",100,200
	C: "OO",300,200
}
)"));
    expect_table(scene);
    EXPECT_EQ(scene.surfaces.at(0).name, "table");
    EXPECT_EQ(scene.notes.at(0).what, "units: centimetres, from the file; Z up, from the file");
}

TEST(GeneralGeometry, ColladaHierarchyCameraAndLight) {
    const Folder folder;
    const Scene scene = read_scene(folder.write("t.dae", R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_cameras><camera id="cam" name="cam"><optics><technique_common><perspective>
<xfov>60</xfov><aspect_ratio>2</aspect_ratio><znear>1</znear><zfar>100</zfar>
</perspective></technique_common></optics></camera></library_cameras>
<library_lights><light id="lamp" name="lamp"><technique_common><point><color>2 2 2</color></point>
</technique_common></light><light id="sun" name="sun"><technique_common><directional>
<color>5 5 5</color></directional></technique_common></light>
<light id="glow" name="glow"><technique_common><ambient><color>1 1 1</color></ambient>
</technique_common></light></library_lights>
<library_effects><effect id="oak-fx"><profile_COMMON><technique sid="common"><lambert>
<diffuse><color>0.5 0.25 0.125 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="oak" name="oak"><instance_effect url="#oak-fx"/></material>
</library_materials>
<library_geometries><geometry id="quad" name="quad"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 100 100 0 0 100 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s" name="s">
<node id="room" name="room"><node id="table" name="table"><translate>100 0 50</translate>
<instance_geometry url="#quad"><bind_material><technique_common>
<instance_material symbol="m" target="#oak"/></technique_common></bind_material>
</instance_geometry></node></node>
<node id="eye" name="eye"><translate>0 0 300</translate><instance_camera url="#cam"/></node>
<node id="bulb" name="bulb"><translate>0 0 200</translate><instance_light url="#lamp"/></node>
<node id="day" name="day"><instance_light url="#sun"/></node>
<node id="haze" name="haze"><instance_light url="#glow"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)"));
    expect_table(scene);
    EXPECT_EQ(scene.surfaces.at(0).name, "room/table");
    EXPECT_EQ(scene.notes.at(0).what, "units: centimetres, from the file; Z up, from the file");
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    expect_vector(scene.cameras[0].eye, {0, 3, 0});
    expect_vector(scene.cameras[0].look_at, {0, 2, 0});
    // tan(fov_y / 2) = tan 30° / 2
    EXPECT_NEAR(std::tan(scene.cameras[0].fov_y * std::numbers::pi / 360),
                std::tan(std::numbers::pi / 6) / 2, rounding);
    ASSERT_EQ(scene.luminaires.size(), 1U);
    expect_vector(scene.luminaires[0].position, {0, 2, 0});
    EXPECT_NEAR(scene.luminaires[0].flux(), 8 * std::numbers::pi, rounding);
    ASSERT_EQ(scene.distant.size(), 1U);
    expect_vector(scene.distant[0].direction, {0, 1, 0});  // it shines along −z, now −y
    EXPECT_NEAR(scene.distant[0].irradiance, 5, rounding);
    EXPECT_TRUE(warned(scene, "no unit"));
    EXPECT_TRUE(warned(scene, "'haze' is neither a point, a spot nor directional"));
}

// A chunk of a 3DS file: id, length with this head, contents.
std::string chunk(std::uint16_t id, const std::string& contents) {
    std::string head(6, '\0');
    const auto length = static_cast<std::uint32_t>(contents.size() + 6);
    std::memcpy(head.data(), &id, 2);
    std::memcpy(head.data() + 2, &length, 4);
    return head + contents;
}

template <class T>
std::string bytes_of(std::initializer_list<T> values) {
    std::string out;
    for (const T value : values) out.append(reinterpret_cast<const char*>(&value), sizeof value);
    return out;
}

TEST(GeneralGeometry, ThreeDsIsTurnedUp) {
    using u16 = std::uint16_t;
    const std::string zero(1, '\0');
    const std::string vertices =
        bytes_of<u16>({4}) + bytes_of<float>({1, 0, .5, 2, 0, .5, 2, 1, .5, 1, 1, .5});
    const std::string faces = bytes_of<u16>({2, 0, 1, 2, 7, 0, 2, 3, 7}) +
                              chunk(0x4130, "oak" + zero + bytes_of<u16>({2, 0, 1}));
    const std::string mesh = chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
    const std::string material =
        chunk(0xafff, chunk(0xa000, "oak" + zero) +
                          chunk(0xa020, chunk(0x0010, bytes_of<float>({.5, .25, .125}))));
    // The object's place in the hierarchy: at its root.
    const std::string hierarchy =
        chunk(0xb000, chunk(0xb002, chunk(0xb010, "table" + zero + bytes_of<u16>({0, 0, 0xffff}))));
    const Folder folder;
    const Scene scene = read_scene(folder.write(
        "t.3ds",
        chunk(0x4d4d, chunk(0x3d3d, material + chunk(0x4000, "table" + zero + mesh)) + hierarchy)));
    expect_table(scene);
    EXPECT_EQ(scene.surfaces.at(0).name, "table");
}

TEST(GeneralGeometry, IfcBlock) {
    const Folder folder;
    const Scene scene = read_scene(folder.write("t.ifc", R"(ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('t.ifc','2020-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('IFC2X3'));
ENDSEC;
DATA;
#1=IFCPROJECT('0000000000000000000001',#2,'project',$,$,$,$,(#20),#7);
#2=IFCOWNERHISTORY(#3,#6,$,.ADDED.,$,$,$,0);
#3=IFCPERSONANDORGANIZATION(#4,#5,$);
#4=IFCPERSON($,$,'x',$,$,$,$,$);
#5=IFCORGANIZATION($,'x',$,$,$);
#6=IFCAPPLICATION(#5,'1','x','x');
#7=IFCUNITASSIGNMENT((#8));
#8=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);
#20=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#21,$);
#21=IFCAXIS2PLACEMENT3D(#22,$,$);
#22=IFCCARTESIANPOINT((0.,0.,0.));
#30=IFCSITE('0000000000000000000002',#2,'site',$,$,#31,$,$,.ELEMENT.,$,$,$,$,$);
#31=IFCLOCALPLACEMENT($,#21);
#32=IFCRELAGGREGATES('0000000000000000000003',#2,$,$,#1,(#30));
#40=IFCBUILDINGELEMENTPROXY('0000000000000000000004',#2,'block',$,$,#31,#50,$,$);
#41=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000005',#2,$,$,(#40),#30);
#50=IFCPRODUCTDEFINITIONSHAPE($,$,(#51));
#51=IFCSHAPEREPRESENTATION(#20,'Body','SweptSolid',(#52));
#52=IFCEXTRUDEDAREASOLID(#53,#21,#54,3000.);
#53=IFCRECTANGLEPROFILEDEF(.AREA.,$,#55,2000.,1000.);
#54=IFCDIRECTION((0.,0.,1.));
#55=IFCAXIS2PLACEMENT2D(#56,$);
#56=IFCCARTESIANPOINT((0.,0.));
ENDSEC;
END-ISO-10303-21;
)"));
    // 2 × 1 m and 3 m high, from millimetres; up is y.
    EXPECT_NEAR(total_area(scene), 2 * (2 * 1 + 2 * 3 + 1 * 3), 1e-5);
    EXPECT_NEAR(scene.bounds().size().x, 2, 1e-5);
    EXPECT_NEAR(scene.bounds().size().y, 3, 1e-5);
    EXPECT_NEAR(scene.bounds().size().z, 1, 1e-5);
}

TEST(GeneralGeometry, BadInputIsRefusedWithItsFile) {
    const Folder folder;
    const auto expect = [&](const char* name, const std::string& bytes, const std::string& words) {
        const auto path = folder.write(name, bytes);
        expect_refused([&] { read_scene(path); }, path.string(), words);
    };
    expect("index.obj", square + "f 1 2 30\n", "cannot be read as OBJ: ");
    expect("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number");
    expect("empty.obj", "", "OBJ");
    expect("zip.dae", std::string("PK\x05\x06") + std::string(18, '\0'), "archive");
    expect("text.dae", "no XML", "Collada");
    expect("text.3ds", "text", "3DS");
    expect("text.fbx", "text", "FBX");
    expect("text.ifc", "text", "IFC");
    expect("cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", "end_header");
    expect("huge.ply",
           "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
           "property float y\nproperty float z\nend_header\n",
           "PLY");
    ReadOptions few;
    few.max_polygons = 1;
    const auto two = folder.write("two.obj", square + "f 1 2 3\nf 1 3 4\n");
    expect_refused([&] { read_scene(two, few); }, two.string(), "--max-polygons");
    // Nothing but the kind that its name says is tried: this is a readable OBJ.
    expect("text.stl", square + "f 1 2 3\n", "STL");
}

TEST(GeneralGeometry, BombsEndAsErrorsWithinASecond) {
    const Folder folder;
    // Each entity is ten of the one before: 10^12 laughs.
    std::string laughs = "<?xml version=\"1.0\"?>\n<!DOCTYPE COLLADA [\n<!ENTITY l0 \"ha\">\n";
    for (int i = 1; i < 13; ++i) {
        laughs += "<!ENTITY l" + std::to_string(i) + " \"";
        for (int k = 0; k < 10; ++k) laughs += "&l" + std::to_string(i - 1) + ";";
        laughs += "\">\n";
    }
    laughs += "]>\n<COLLADA version=\"1.4.1\"><asset>&l12;</asset></COLLADA>\n";
    std::string deep = "<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\">";
    for (int i = 0; i < 100'000; ++i) deep += "<node>";
    for (const auto& [name, bytes] : {std::pair{"laughs.dae", laughs},
                                      std::pair{"deep.dae", deep},
                                      {"zip.dae", "PK\3\4 bomb PK\5\6" + std::string(18, '\0')}}) {
        const auto path = folder.write(name, bytes);
        const auto read = [&] {
            expect_refused([&] { read_scene(path); }, path.string(), "cannot be read as Collada");
        };
        EXPECT_TRUE(testing::quick(read)) << name;
    }
}

TEST(GeneralGeometry, CrashesAndExcessEndAsFailures) {
    const auto message = [](const std::function<std::string()>& work, const CallLimits& limits) {
        try {
            contained_call(work, limits);
        } catch (const CallFailed& failure) {
            return std::string(failure.what());
        }
        return std::string("it returned");
    };
    EXPECT_EQ(contained_call([] { return std::string("answer"); }, {}), "answer");
    EXPECT_EQ(contained_call([] { return std::string(1 << 20, 'x'); }, {}).size(), 1U << 20);
    EXPECT_EQ(message([]() -> std::string { throw std::runtime_error("why"); }, {}), "why");
    EXPECT_NE(message(
                  []() -> std::string {
                      ::raise(SIGSEGV);
                      return "";
                  },
                  {})
                  .find("crash"),
              std::string::npos);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_NE(message([] { return std::string(std::size_t{1} << 30, 'x'); }, {1 << 24, 60})
                  .find("memory"),
              std::string::npos);
#endif
    const auto start = std::chrono::steady_clock::now();
    const auto forever = []() -> std::string {
        for (volatile unsigned i = 0;;) i = i + 1;
    };
    EXPECT_NE(message(forever, {1 << 24, 1}).find("more than 1 s"), std::string::npos);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace
}  // namespace exitance
