/// Reads STEP and IGES files, heals and triangulates their solids. The only user of OpenCASCADE.
#include "cad.hpp"
#include "mesh_words.hpp"

#include <sys/mman.h>
#include <unistd.h>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeFix_Solid.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace bin_scenes {

bool reads_cad() {
  return true;
}

namespace cad {

namespace {

constexpr double millimetre = 1e-3;      ///< m; OpenCASCADE converts all lengths to it
constexpr double finest_share = 2e-4;    ///< of the diagonal: chord where none is given
constexpr double coarsest_share = 0.05;  ///< of the diagonal
constexpr double touching_share = 1e-6;  ///< of the diagonal: solids nearer than that touch
constexpr std::size_t most_fused = 60;   ///< solids; more stay as they are, and are united as triangles

struct Refused {
  std::string complaint, remedy;
};

struct Named {
  std::string name;
  TopoDS_Shape shape;
};

/// The readers take names of files. In memory, so that nothing is left behind when they crash.
class FileInMemory {
 public:
  explicit FileInMemory(const std::string& bytes) : file_(memfd_create("cad", 0)) {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t n = write(file_, bytes.data() + at, bytes.size() - at);
      if (n <= 0) throw std::bad_alloc();
      at += static_cast<std::size_t>(n);
    }
  }
  ~FileInMemory() { close(file_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// Names of products by the shapes that they became, wherever these lie.
using Names = std::vector<std::pair<TopoDS_Shape, std::string>>;

/// All solids of an assembly in their places, and the faces that belong to none.
class Collector {
 public:
  std::vector<Named> solids;
  std::vector<TopoDS_Shape> faces;

  Collector(const TopoDS_Shape& whole, const Names& names) : names_(names) {
    add(whole, "solid");
    std::map<std::string, int> seen;  // each has a name of its own: bolt, bolt#2, bolt#3
    for (Named& solid : solids)
      if (const int n = ++seen[solid.name]; n > 1) solid.name += "#" + std::to_string(n);
  }

 private:
  /// A solid has the name of the innermost product around it.
  void add(const TopoDS_Shape& shape, const std::string& outer) {
    if (shape.IsNull()) return;
    const auto known =
        std::find_if(names_.begin(), names_.end(), [&](const auto& named) { return named.first.IsPartner(shape); });
    const std::string& name = known == names_.end() ? outer : known->second;
    if (shape.ShapeType() == TopAbs_SOLID) return solids.push_back({name, shape});
    if (shape.ShapeType() == TopAbs_FACE) return faces.push_back(shape);
    for (TopoDS_Iterator part(shape); part.More(); part.Next())
      if (part.Value().ShapeType() <= TopAbs_FACE) add(part.Value(), name);
  }

  const Names& names_;
};

/// m; of what ISO 10303 and the CAD systems write.
double metres_of(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::map<std::string, double> known = {
      {"metre", 1.0},       {"meter", 1.0},       {"m", 1.0},           {"millimetre", 1e-3}, {"millimeter", 1e-3},
      {"mm", 1e-3},         {"centimetre", 1e-2}, {"centimeter", 1e-2}, {"cm", 1e-2},         {"micrometre", 1e-6},
      {"micrometer", 1e-6}, {"inch", 0.0254},     {"in", 0.0254},       {"foot", 0.3048},     {"ft", 0.3048},
      {"decimetre", 1e-1},  {"kilometre", 1e3}};
  const auto found = known.find(name);
  return found == known.end() ? 0.0 : found->second;
}

[[noreturn]] void refuse_damaged(const std::string& format) {
  throw Refused{"cannot be read as " + format + ": the file is damaged or cut off", "copy or export it again"};
}

/// All that a reader finds in a file, in mm.
TopoDS_Shape transferred(XSControl_Reader& reader, const std::string& format) {
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) throw Refused{"holds no shape that can be read as " + format, "export the part as a solid"};
  return shape;
}

Names names_in_step(const STEPControl_Reader& reader) {
  Names names;
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  const Handle(Interface_InterfaceModel) model = reader.Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(model->Value(i));
    if (definition.IsNull() || definition->Formation().IsNull() || definition->Formation()->OfProduct().IsNull())
      continue;
    const Handle(TCollection_HAsciiString) name = definition->Formation()->OfProduct()->Name();
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, definition);
    if (!shape.IsNull() && !name.IsNull() && name->Length() > 0) names.emplace_back(shape, name->ToCString());
  }
  return names;
}

Collector read_step(const FileInMemory& file, Solids& result) {
  STEPControl_Reader reader;
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone) refuse_damaged("STEP");
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (lengths.IsEmpty() || !(metres_of(lengths.First().ToCString()) > 0.0)) {
    result.flags.push_back({"unit_unknown", "the file states no unit of length that is known; millimetres are taken",
                            "give the part's unit"});
  } else {
    result.metres_per_unit = metres_of(lengths.First().ToCString());
  }
  const TopoDS_Shape whole = transferred(reader, "STEP");
  return Collector(whole, names_in_step(reader));
}

Collector read_iges(const FileInMemory& file, Solids& result) {
  IGESControl_Reader reader;
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone) refuse_damaged("IGES");
  const double unit = reader.IGESModel()->GlobalSection().UnitValue();  // mm
  if (unit > 0.0) result.metres_per_unit = millimetre * unit;
  return Collector(transferred(reader, "IGES"), {});
}

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

TopoDS_Shell shell_of(const TopoDS_Shape& face) {
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  builder.Add(shell, face);
  return shell;
}

/// What IGES has, and STEP of surfaces: faces that close become a solid.
TopoDS_Shape sewn(const std::vector<TopoDS_Shape>& faces, bool surfaces_do, Solids& result) {
  const double tolerance = std::max(1e-3, 1e-5 * diagonal_of(compound_of(faces)));
  BRepBuilderAPI_Sewing sewing(tolerance);
  for (const TopoDS_Shape& face : faces) sewing.Add(face);
  sewing.Perform();
  std::vector<TopoDS_Shell> shells;
  for (TopExp_Explorer each(sewing.SewedShape(), TopAbs_SHELL); each.More(); each.Next())
    shells.push_back(TopoDS::Shell(each.Current()));
  for (TopExp_Explorer each(sewing.SewedShape(), TopAbs_FACE, TopAbs_SHELL); each.More(); each.Next())
    shells.push_back(shell_of(each.Current()));  // a torus is one face
  std::vector<TopoDS_Shape> solids;
  for (const TopoDS_Shell& shell : shells)
    if (BRep_Tool::IsClosed(shell)) solids.push_back(ShapeFix_Solid().SolidFromShell(shell));
  const bool closed = solids.size() == shells.size();
  if (closed && !solids.empty()) {
    result.count = solids.size();
    result.flags.push_back({"faces_sewn",
                            "no solid in the file: its " + count(faces.size(), "face") + " were sewn to " +
                                count(solids.size(), "closed shell"),
                            "nothing to do, or export a solid"});
    return compound_of(solids);
  }
  if (!surfaces_do)
    throw Refused{"holds " + count(faces.size(), "face") + ", but no solid, and they do not close",
                  "export the part as a solid, or give a thickness to make a shell of them"};
  return sewing.SewedShape();
}

std::string listed(const std::vector<Named>& solids) {
  constexpr std::size_t most = 12;
  std::string names;
  for (std::size_t i = 0; i < std::min(solids.size(), most); ++i) names += (i ? ", '" : "'") + solids[i].name + "'";
  return solids.size() > most ? names + " and " + std::to_string(solids.size() - most) + " more" : names;
}

/// Whether a path leads from each solid to each other over solids that touch.
bool hang_together(const std::vector<Named>& solids, double tolerance) {
  std::vector<Bnd_Box> boxes(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    BRepBndLib::Add(solids[i].shape, boxes[i], false);
    boxes[i].Enlarge(tolerance);
  }
  std::vector<std::size_t> reached = {0}, others(solids.size() - 1);
  std::iota(others.begin(), others.end(), 1);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto apart = [&](std::size_t other) {
      if (boxes[reached[i]].IsOut(boxes[other])) return true;
      const BRepExtrema_DistShapeShape distance(solids[reached[i]].shape, solids[other].shape);
      return !distance.IsDone() || distance.Value() > tolerance;
    };
    const auto touching = std::stable_partition(others.begin(), others.end(), apart);
    reached.insert(reached.end(), touching, others.end());
    others.erase(touching, others.end());
  }
  return others.empty();
}

/// Solids that touch are one part, without walls inside.
TopoDS_Shape fused(const std::vector<Named>& solids) {
  std::vector<TopoDS_Shape> shapes;
  for (const Named& solid : solids) shapes.push_back(solid.shape);
  if (shapes.size() > most_fused) return compound_of(shapes);
  TopTools_ListOfShape first, others;
  first.Append(shapes.front());
  for (std::size_t i = 1; i < shapes.size(); ++i) others.Append(shapes[i]);
  BRepAlgoAPI_Fuse fuse;
  fuse.SetArguments(first);
  fuse.SetTools(others);
  fuse.Build();
  return fuse.IsDone() && !fuse.HasErrors() && TopExp_Explorer(fuse.Shape(), TopAbs_SOLID).More() ? fuse.Shape()
                                                                                                  : compound_of(shapes);
}

TopoDS_Shape chosen(const Collector& all, const LoadOptions& options, Solids& result) {
  const std::vector<Named>& solids = all.solids;
  if (!options.solid.empty()) {
    for (const Named& solid : solids)
      if (solid.name == options.solid) return solid.shape;
    throw Refused{"has no solid '" + options.solid + "'",
                  solids.empty() ? "there is none: leave the key out" : "there are " + listed(solids)};
  }
  if (solids.empty()) {
    if (all.faces.empty()) throw Refused{"holds no solid and no face", "export the part as a solid"};
    return sewn(all.faces, options.thickness || !options.require_closed, result);
  }
  if (!all.faces.empty())
    result.flags.push_back({"faces_left_out", count(all.faces.size(), "face") + " beside the solids were left out",
                            "remove them from the file, or make a solid of them"});
  if (solids.size() == 1) return solids.front().shape;
  std::vector<TopoDS_Shape> shapes;
  for (const Named& solid : solids) shapes.push_back(solid.shape);
  if (!hang_together(solids, touching_share * diagonal_of(compound_of(shapes))))
    throw Refused{"holds " + count(solids.size(), "solid") + " that do not all touch: " + listed(solids),
                  "choose one: solid: NAME"};
  result.flags.push_back({"solids_fused", count(solids.size(), "solid") + " that touch are one part: " + listed(solids),
                          "nothing to do, or choose one: solid: NAME"});
  return fused(solids);
}

/// Largest distance of the surface from the plane of a triangle, in its centre and over its edges.
double sag(const BRepAdaptor_Surface& surface, const std::array<gp_Pnt2d, 3>& uv, const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(normal.norm() > 0.0)) return 0.0;
  double worst = 0.0;
  const auto look = [&](double a, double b, double c) {
    const gp_Pnt p =
        surface.Value(a * uv[0].X() + b * uv[1].X() + c * uv[2].X(), a * uv[0].Y() + b * uv[1].Y() + c * uv[2].Y());
    worst = std::max(worst, std::abs((Vec3(p.X(), p.Y(), p.Z()) - corners[0]).dot(normal)) / normal.norm());
  };
  look(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0);
  look(0.5, 0.5, 0.0), look(0.0, 0.5, 0.5), look(0.5, 0.0, 0.5);
  return worst;
}

void append(const TopoDS_Face& face, Solids& result) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, place);
  if (triangles.IsNull()) throw Refused{"has a face that cannot be made triangles", "heal the part in the modeller"};
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  const BRepAdaptor_Surface surface(face);
  Mesh& mesh = result.mesh;
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 1; i <= triangles->NbNodes(); ++i) {
    const gp_Pnt p = triangles->Node(i).Transformed(place.Transformation());
    mesh.vertices.emplace_back(p.X(), p.Y(), p.Z());
  }
  for (int i = 1; i <= triangles->NbTriangles(); ++i) {
    std::array<int, 3> node;
    triangles->Triangle(i).Get(node[0], node[1], node[2]);
    if (reversed) std::swap(node[1], node[2]);
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = base + static_cast<std::uint32_t>(node[k] - 1);
    mesh.triangles.push_back(triangle);
    if (!triangles->HasUVNodes()) continue;
    result.error = std::max(
        result.error, sag(surface, {triangles->UVNode(node[0]), triangles->UVNode(node[1]), triangles->UVNode(node[2])},
                          {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]}));
  }
}

void tessellate(const TopoDS_Shape& shape, const LoadOptions& options, Solids& result) {
  const double diagonal = diagonal_of(shape);
  const Tessellation& fine = options.tessellation;
  // A chord as large as the part would let its angle be forgotten.
  const double chord = fine.chord ? std::min(*fine.chord / millimetre / options.scale, coarsest_share * diagonal)
                                  : finest_share * diagonal;
  if (!(diagonal > 0.0)) throw Refused{"holds a solid without size", "export the part again"};
  BRepMesh_IncrementalMesh(shape, chord, false, fine.angle, false);
  for (TopExp_Explorer each(shape, TopAbs_FACE); each.More(); each.Next()) append(TopoDS::Face(each.Current()), result);
  if (result.mesh.empty()) throw Refused{"holds no face that can be made triangles", "export the part as a solid"};
  const double unit = result.metres_per_unit / millimetre;
  for (Vec3& v : result.mesh.vertices) v /= unit;
  result.error /= unit;
}

}  // namespace

Solids read_here(const std::string& bytes, const std::string& format, const LoadOptions& options) {
  Solids result;
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    const FileInMemory file(bytes);
    if (access(file.path().c_str(), R_OK) != 0)
      throw Refused{"is read through /proc, which is not mounted here", "mount it, or give the part as STL"};
    const Collector all = format == "STEP" ? read_step(file, result) : read_iges(file, result);
    result.count = all.solids.size();
    tessellate(chosen(all, options, result), options, result);
  } catch (const Refused& refused) {
    result.complaint = refused.complaint;
    result.remedy = refused.remedy;
  } catch (const Standard_Failure& failure) {
    result.complaint = "cannot be read as " + format + ": OpenCASCADE says " + failure.GetMessageString();
    result.remedy = "heal the part in the modeller, or export an STL file";
  }
  return result;
}

}  // namespace cad

}  // namespace bin_scenes
