#include "collada.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <locale>
#include <set>
#include <sstream>
#include <stdexcept>

namespace bin_scenes::collada {

namespace {

void parse(tinyxml2::XMLDocument& xml, const std::string& document) {
  xml.Parse(document.data(), document.size());
  if (xml.Error()) throw std::runtime_error(std::string("not well-formed XML: ") + xml.ErrorStr());
  if (!xml.RootElement() || std::string(xml.RootElement()->Name()) != "COLLADA") {
    throw std::runtime_error("the XML document is not COLLADA");
  }
}

void remove_elements(tinyxml2::XMLElement& parent, const std::set<std::string>& names) {
  for (tinyxml2::XMLElement* child = parent.FirstChildElement(); child;) {
    tinyxml2::XMLElement* next = child->NextSiblingElement();
    if (names.count(child->Name())) {
      parent.DeleteChild(child);
    } else {
      remove_elements(*child, names);
    }
    child = next;
  }
}

}  // namespace

Asset read_asset(const std::string& document) {
  tinyxml2::XMLDocument xml;
  parse(xml, document);
  Asset asset;
  const tinyxml2::XMLElement* element = xml.RootElement()->FirstChildElement("asset");
  if (!element) return asset;
  if (const auto* unit = element->FirstChildElement("unit")) {
    if (const char* metres = unit->Attribute("meter")) {
      std::string text = metres;
      std::replace(text.begin(), text.end(), ',', '.');  // written in a locale with decimal commas
      std::istringstream stream(text);
      stream.imbue(std::locale::classic());
      double value = 0.0;
      if (!(stream >> value) || !(value > 0.0)) {
        throw std::runtime_error("states a unit of \"" + std::string(metres) + "\" metres");
      }
      asset.metres_per_unit = value;
    }
  }
  if (const auto* up = element->FirstChildElement("up_axis")) {
    if (up->GetText()) asset.up_axis = up->GetText();
  }
  return asset;
}

std::string geometry_only(const std::string& document) {
  tinyxml2::XMLDocument xml;
  parse(xml, document);
  remove_elements(*xml.RootElement(),
                  {"library_images", "library_materials", "library_effects", "library_lights", "library_cameras",
                   "library_animations", "library_animation_clips", "library_force_fields", "library_physics_materials",
                   "library_physics_models", "library_physics_scenes", "bind_material", "instance_light",
                   "instance_camera", "instance_physics_scene", "extra"});
  tinyxml2::XMLPrinter printer(nullptr, true);
  xml.Print(&printer);
  return printer.CStr();
}

}  // namespace bin_scenes::collada
