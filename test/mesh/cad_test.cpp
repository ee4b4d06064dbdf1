/// STEP and IGES files written by OpenCASCADE itself, against closed forms.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/part/part_model.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <GCE2d_MakeSegment.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

class Cad : public ::testing::Test {
 protected:
  void SetUp() override {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    folder_ = fs::temp_directory_path() / ("cad_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::string step(const TopoDS_Shape& shape, const char* unit = "MM", const std::string& name = "part.step") const {
    STEPControl_Writer().WS();  // the settings are there from the first writer on
    Interface_Static::SetCVal("write.step.unit", unit);
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    EXPECT_EQ(writer.Write(file(name).c_str()), IFSelect_RetDone);
    return kept(file(name));
  }
  /// For test/readers/step_test.js, which lets another program read what is written here.
  static std::string kept(const std::string& path) {
    static int number = 0;
    if (const char* folder = std::getenv("CAD_TEST_KEEP"))
      fs::copy_file(path, fs::path(folder) / (std::to_string(number++) + "_" + fs::path(path).filename().string()));
    return path;
  }
  std::string iges(const TopoDS_Shape& shape, const char* unit = "MM", int solids = 0) const {
    IGESControl_Writer writer(unit, solids);
    writer.AddShape(shape);
    writer.ComputeModel();
    EXPECT_TRUE(writer.Write(file("part.igs").c_str()));
    return file("part.igs");
  }
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  fs::path folder_;
};

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

PartModelPtr part_of(const std::string& path, const LoadOptions& options = {}) {
  return PartModel::from_mesh(load_mesh(path, options).mesh, "part");
}

void expect_error(const std::string& path, const std::vector<std::string>& texts, const LoadOptions& options = {}) {
  try {
    load_mesh(path, options);
    ADD_FAILURE() << path << " was read";
  } catch (const Error& error) {
    const std::string text = error.what();
    for (const std::string& expected : texts) EXPECT_NE(text.find(expected), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

/// Volume, area and the moments about the centre of mass (mm, as OpenCASCADE has them) within `share`; the default
/// tessellation is inscribed.
void expect_mass(const PartModel& part, const TopoDS_Shape& shape, double share) {
  GProp_GProps volume, area;
  BRepGProp::VolumeProperties(shape, volume, 1e-6);  // adaptive: the default errs on a thread
  BRepGProp::SurfaceProperties(shape, area, 1e-6);
  const MassProperties& mass = part.mass();
  EXPECT_NEAR(mass.volume, 1e-9 * volume.Mass(), share * mass.volume);
  EXPECT_NEAR(mass.area, 1e-6 * area.Mass(), share * mass.area);
  const gp_Pnt center = volume.CentreOfMass();
  EXPECT_LT((mass.center - 1e-3 * Vec3(center.X(), center.Y(), center.Z())).norm(), share * part.diagonal());
  const gp_Mat moments = volume.MatrixOfInertia();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(mass.inertia(i, j), 1e-15 * moments(i + 1, j + 1), 2.0 * share * mass.inertia.trace());
}

/// A bolt's thread as OpenCASCADE's tutorial of the bottle makes it, cut out of nothing: a helical solid.
TopoDS_Shape thread(double radius, double height) {
  const gp_Ax2 axis(gp_Pnt(0, 0, 0), gp::DZ());
  const Handle(Geom_CylindricalSurface) inner = new Geom_CylindricalSurface(axis, radius * 0.99);
  const Handle(Geom_CylindricalSurface) outer = new Geom_CylindricalSurface(axis, radius * 1.05);
  const gp_Ax2d line(gp_Pnt2d(2.0 * M_PI, height / 2.0), gp_Dir2d(2.0 * M_PI, height / 4.0));
  const double major = 2.0 * M_PI, minor = height / 10.0;
  const Handle(Geom2d_Ellipse) wide = new Geom2d_Ellipse(line, major, minor);
  const Handle(Geom2d_Ellipse) narrow = new Geom2d_Ellipse(line, major, minor / 4.0);
  const Handle(Geom2d_TrimmedCurve) arc = new Geom2d_TrimmedCurve(wide, 0, M_PI);
  const Handle(Geom2d_TrimmedCurve) top = new Geom2d_TrimmedCurve(narrow, 0, M_PI);
  const Handle(Geom2d_TrimmedCurve) segment = GCE2d_MakeSegment(wide->Value(0), wide->Value(M_PI)).Value();
  const auto wire = [&](const Handle(Geom2d_TrimmedCurve) & curve, const Handle(Geom_CylindricalSurface) & surface) {
    const TopoDS_Wire made =
        BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve, surface), BRepBuilderAPI_MakeEdge(segment, surface));
    BRepLib::BuildCurves3d(made);
    return made;
  };
  BRepOffsetAPI_ThruSections tool(true);
  tool.AddWire(wire(arc, inner));
  tool.AddWire(wire(top, outer));
  tool.CheckCompatibility(false);
  return tool.Shape().Reversed();  // the tutorial's faces look inwards
}

/// In a process of its own, from whose file system /proc is taken.
TEST_F(Cad, WithoutProcTheTrueCauseIsTold) {
  const std::string path = step(BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape());
  constexpr int told = 0, not_told = 1, not_allowed = 2;
  const pid_t pid = fork();
  if (pid == 0) {
    const bool gone = unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                      umount2("/proc", MNT_DETACH) == 0;
    if (!gone) _exit(not_allowed);
    try {
      load_mesh(path);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(error.problem().find("through /proc, which is not mounted") == std::string::npos ? not_told : told);
    }
    _exit(not_told);
  }
  int status = 0;
  ASSERT_EQ(waitpid(pid, &status, 0), pid);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == not_allowed) GTEST_SKIP() << "needs the right to unmount";
  EXPECT_EQ(WEXITSTATUS(status), told);
}

}  // namespace

TEST_F(Cad, ABoxIsExactInEachUnitOfItsFile) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(1, 2, 3), 30.0, 20.0, 10.0).Shape();
  for (const auto& [unit, metres] :
       std::vector<std::pair<const char*, double>>{{"MM", 1e-3}, {"M", 1.0}, {"INCH", 0.0254}, {"CM", 1e-2}}) {
    for (const std::string& path : {step(box, unit), iges(box, unit), iges(box, unit, 1)}) {
      SCOPED_TRACE(std::string(unit) + " " + path);
      const LoadedMesh loaded = load_mesh(path);
      const Aabb bounds = loaded.mesh.bounds();
      EXPECT_LT((bounds.lower - Vec3(0.001, 0.002, 0.003)).norm(), 1e-8);
      EXPECT_LT((bounds.size() - Vec3(0.03, 0.02, 0.01)).norm(), 1e-8);
      EXPECT_NEAR(loaded.report.metres_per_unit, metres, 1e-12);
      EXPECT_EQ(loaded.mesh.triangles.size(), 12u);
      EXPECT_LT(loaded.report.tessellation_error, 1e-9);
      EXPECT_TRUE(loaded.report.closed);
    }
  }
  LoadOptions other;
  other.unit = Unit::centimetre;  // given, it rules
  const LoadedMesh larger = load_mesh(step(box), other);
  EXPECT_NEAR(larger.mesh.bounds().size().x(), 0.3, 1e-8);
  EXPECT_EQ(larger.report.flags.front().code, "unit_overridden");
}

TEST_F(Cad, CurvedSolidsHaveTheirVolumeAreaAndMoments) {
  const double r = 12.0, h = 40.0;
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(r, h).Shape();
  const PartModelPtr part = part_of(step(cylinder));
  EXPECT_NEAR(part->mass().volume, 1e-9 * M_PI * r * r * h, 2e-3 * part->mass().volume);
  const double about_axis = 0.5 * 1e-6 * r * r * part->mass().volume;
  EXPECT_NEAR(part->mass().inertia(2, 2), about_axis, 4e-3 * about_axis);
  for (const TopoDS_Shape& shape :
       {cylinder, BRepPrimAPI_MakeTorus(20.0, 6.0).Shape(), BRepPrimAPI_MakeCone(15.0, 5.0, 30.0).Shape(),
        BRepPrimAPI_MakeCone(15.0, 0.0, 30.0).Shape(), thread(10.0, 30.0),
        BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(40.0, 40.0, 10.0).Shape(),
                        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(20, 20, -1), gp::DZ()), 8.0, 12.0).Shape())
            .Shape()}) {
    expect_mass(*part_of(step(shape)), shape, 5e-3);
    expect_mass(*part_of(iges(shape)), shape, 5e-3);
  }
}

TEST_F(Cad, TheErrorToldIsThatOfTheTriangles) {
  const double r = 10.0;
  const std::string path = step(BRepPrimAPI_MakeCylinder(r, 30.0).Shape());
  LoadOptions options;
  options.tessellation.angle = 1.0;
  std::size_t triangles = 0;
  for (const double chord : {1e-3, 1e-4, 1e-5}) {
    options.tessellation.chord = chord;
    const LoadedMesh loaded = load_mesh(path, options);
    double worst = 0.0;  // of the middles of edges from the cylinder
    for (const Triangle& t : loaded.mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const Vec3 middle = 0.5 * (loaded.mesh.vertices[t[k]] + loaded.mesh.vertices[t[(k + 1) % 3]]);
        const Vec3 &a = loaded.mesh.vertices[t[k]], &b = loaded.mesh.vertices[t[(k + 1) % 3]];
        const bool around = std::abs(std::hypot(a.x(), a.y()) - 1e-3 * r) < 1e-7 &&
                            std::abs(std::hypot(b.x(), b.y()) - 1e-3 * r) < 1e-7;
        const bool flat = std::abs(loaded.mesh.vertices[t[0]].z() - loaded.mesh.vertices[t[1]].z()) < 1e-9 &&
                          std::abs(loaded.mesh.vertices[t[0]].z() - loaded.mesh.vertices[t[2]].z()) < 1e-9;
        if (around && !flat) worst = std::max(worst, 1e-3 * r - std::hypot(middle.x(), middle.y()));
      }
    EXPECT_LE(loaded.report.tessellation_error, chord);
    EXPECT_NEAR(loaded.report.tessellation_error, worst, 0.02 * worst);
    EXPECT_GT(loaded.mesh.triangles.size(), triangles);
    triangles = loaded.mesh.triangles.size();
  }
  options.tessellation.chord = 1.0;
  options.tessellation.angle = 0.05;
  EXPECT_GE(load_mesh(path, options).mesh.triangles.size(), 4 * static_cast<std::size_t>(2.0 * M_PI / 0.05) - 8);
  options.tessellation.angle = 0.0;
  expect_error(path, {"tessellation.angle is 0"}, options);
}

TEST_F(Cad, TheDefaultIsFinerThanTheFieldOfTheSolver) {
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeTorus(20.0, 6.0).Shape(), BRepPrimAPI_MakeCylinder(12.0, 40.0).Shape()}) {
    const std::string path = step(shape);
    const PartModelPtr part = part_of(path);
    const double of_triangles = load_mesh(path).report.tessellation_error / part->diagonal();
    EXPECT_LT(of_triangles, 3e-4);
    EXPECT_LT(of_triangles, part->field_error({}).to_mesh_max);
  }
}

TEST_F(Cad, SolidsThatTouchAreOnePartAndOthersAreListed) {
  const auto document = [](double gap) {
    const Handle(TDocStd_Document) made = new TDocStd_Document("BinXCAF");
    const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(made->Main());
    const TDF_Label base = tool->AddShape(BRepPrimAPI_MakeBox(20.0, 20.0, 10.0).Shape(), false);
    TDataStd_Name::Set(base, "base plate");
    const TDF_Label pin = tool->AddShape(BRepPrimAPI_MakeCylinder(4.0, 15.0).Shape(), false);
    TDataStd_Name::Set(pin, "pin");
    const TDF_Label assembly = tool->NewShape();
    TDataStd_Name::Set(assembly, "assembly");
    tool->AddComponent(assembly, base, TopLoc_Location());
    for (const double x : {5.0, 15.0}) {
      gp_Trsf place;
      place.SetTranslation(gp_Vec(x, 10.0, 10.0 + gap));
      tool->AddComponent(assembly, pin, TopLoc_Location(place));
    }
    tool->UpdateAssemblies();
    return made;
  };
  const auto write = [&](double gap) {
    STEPControl_Writer().WS();
    Interface_Static::SetCVal("write.step.unit", "MM");
    STEPCAFControl_Writer writer;
    writer.Transfer(document(gap), STEPControl_AsIs);
    EXPECT_EQ(writer.Write(file("assembly.stp").c_str()), IFSelect_RetDone);
    return kept(file("assembly.stp"));
  };
  const double pin = M_PI * 16.0 * 15.0, base = 4000.0;
  const LoadedMesh whole = load_mesh(write(0.0));
  EXPECT_EQ(whole.report.shells, 1u) << "no walls inside";
  EXPECT_NEAR(PartModel::from_mesh(whole.mesh, "whole")->mass().volume, 1e-9 * (base + 2.0 * pin),
              1e-9 * 2e-3 * 2.0 * pin);
  EXPECT_EQ(whole.report.meshes, 3u);

  const std::string apart = write(0.1);
  expect_error(apart, {"holds 3 solids that do not all touch: 'base plate', 'pin', 'pin#2'", "solid: NAME"});
  LoadOptions options;
  options.solid = "pin#2";
  const LoadedMesh second = load_mesh(apart, options);
  EXPECT_NEAR(second.mesh.bounds().center().x(), 0.015, 1e-6);
  EXPECT_NEAR(second.mesh.bounds().lower.z(), 0.0101, 1e-8);
  EXPECT_NEAR(PartModel::from_mesh(second.mesh, "pin")->mass().volume, 1e-9 * pin, 1e-9 * 5e-3 * pin);
  options.solid = "pim";
  expect_error(apart, {"has no solid 'pim'", "there are 'base plate', 'pin', 'pin#2'"}, options);
  options.solid = "pin";
  expect_error(written("part.stl", "solid x\nfacet\nendsolid\n"), {"'solid' selects a solid of a STEP or IGES file"},
               options);
}

TEST_F(Cad, SurfacesThatCloseAreSewnAndOthersRefused) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(30.0, 20.0, 10.0).Shape();
  TopoDS_Compound all, five;
  BRep_Builder builder;
  builder.MakeCompound(all);
  builder.MakeCompound(five);
  int n = 0;
  for (TopExp_Explorer each(box, TopAbs_FACE); each.More(); each.Next()) {
    builder.Add(all, each.Current());
    if (++n > 1) builder.Add(five, each.Current());
  }
  const LoadedMesh loaded = load_mesh(step(all));
  EXPECT_TRUE(loaded.report.closed);
  EXPECT_EQ(loaded.report.flags.front().code, "faces_sewn");
  EXPECT_NEAR(PartModel::from_mesh(loaded.mesh, "box")->mass().volume, 6e-6, 1e-12);
  expect_error(step(five), {"holds 5 faces, but no solid, and they do not close", "give a thickness"});
  LoadOptions shell;
  shell.thickness = 1e-3;
  EXPECT_TRUE(load_mesh(step(five), shell).report.closed);
  LoadOptions looked_at;
  looked_at.require_closed = false;
  EXPECT_FALSE(load_mesh(step(five), looked_at).report.closed);
}

TEST_F(Cad, DamagedFilesEndInOneError) {
  const std::string good = text_of(step(BRepPrimAPI_MakeTorus(20.0, 6.0).Shape()));
  for (const double share : {0.05, 0.3, 0.6, 0.95})
    expect_error(
        written("cut.step", good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())))),
        {"cut.step"});
  expect_error(written("empty.step", ""), {"the file is empty"});
  expect_error(written("noise.step", std::string(5000, '\x7f')), {"is named .STEP, but its contents are not"});
  expect_error(written("named.stl", good), {"is named .STL, but its contents are STEP"});
  expect_error(written("head.step", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"),
               {"head.step"});
  const std::string iges_text = text_of(iges(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape()));
  expect_error(written("cut.igs", iges_text.substr(0, iges_text.size() / 2)), {"cut.igs"});
  std::string unknown = good;
  const std::string unit = "SI_UNIT(.MILLI.,.METRE.)";
  ASSERT_NE(unknown.find(unit), std::string::npos);
  unknown.replace(unknown.find(unit), unit.size(), "SI_UNIT(.MILLI.,.GRAM.)");
  try {
    const LoadedMesh loaded = load_mesh(written("unit.step", unknown));
    EXPECT_EQ(loaded.report.flags.front().code, "unit_unknown");
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("unit.step"), std::string::npos);
  }
}

TEST_F(Cad, FiftyMegabytesAreReadOrRefusedWithinLimits) {
  // A comment of that size, then one of that many entities that nothing uses.
  const std::string good = text_of(step(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape()));
  const std::size_t data = good.find("DATA;") + 5;
  std::string points;
  for (int i = 0; points.size() < 50'000'000; ++i)
    points += "\n#" + std::to_string(1'000'000 + i) + "=CARTESIAN_POINT('',(1.,2.,3.));";
  const std::string path = written("large.step", good.substr(0, data) + points + good.substr(data));
  try {
    EXPECT_EQ(load_mesh(path).mesh.triangles.size(), 12u);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be read as STEP: OpenCASCADE"), std::string::npos) << error.what();
  }
}

TEST_F(Cad, IsCachedByContentAndOptions) {
  const std::string path = step(BRepPrimAPI_MakeCylinder(10.0, 30.0).Shape());
  LoadOptions coarse;
  coarse.tessellation.chord = 1e-3;
  coarse.tessellation.angle = 1.0;
  const PartModelPtr fine = PartModel::load(path), again = PartModel::load(path), rough = PartModel::load(path, coarse);
  EXPECT_EQ(fine, again);
  EXPECT_GT(fine->mesh().triangles.size(), 2 * rough->mesh().triangles.size());
  EXPECT_GT(rough->load_report().tessellation_error, 5 * fine->load_report().tessellation_error);
}

}  // namespace bin_scenes
