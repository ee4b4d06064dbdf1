/// A mesh as the text of a COLLADA file.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <sstream>
#include <string>
#include <vector>

namespace bin_scenes {

/// One geometry, one instance a matrix. `extra` goes before the scene (libraries).
inline std::string dae(const Mesh& mesh, const std::string& asset, const std::vector<std::string>& matrices = {""},
                       const std::string& extra = "", const std::string& material = "") {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\">"
      << "<asset>" << asset << "</asset>" << extra << "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
      << "<float_array id=\"a\" count=\"" << 3 * mesh.vertices.size() << "\">";
  for (const Vec3& v : mesh.vertices) out << v.transpose() << " ";
  out << "</float_array><technique_common><accessor source=\"#a\" count=\"" << mesh.vertices.size()
      << "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
      << "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
      << "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\""
      << mesh.triangles.size() << "\"" << (material.empty() ? "" : " material=\"m\"")
      << "><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>";
  for (const Triangle& t : mesh.triangles) out << t[0] << " " << t[1] << " " << t[2] << " ";
  out << "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">";
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    out << "<node id=\"n" << i << "\">";
    if (!matrices[i].empty()) out << "<matrix>" << matrices[i] << "</matrix>";
    out << "<instance_geometry url=\"#g\">" << material << "</instance_geometry></node>";
  }
  out << "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  return out.str();
}

}  // namespace bin_scenes
