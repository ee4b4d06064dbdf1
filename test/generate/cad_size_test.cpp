/// A CAD file states its unit: a part of it that is too large is not advised to take another one.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "generate/model_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <STEPControl_Writer.hxx>

#include <filesystem>

namespace bin_scenes {

TEST(CadSize, APartTooLargeIsNotAdvisedToTakeAnotherUnit) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("cad_size_" + std::to_string(getpid()) + ".step")).string();
  STEPControl_Writer writer;
  writer.Transfer(BRepPrimAPI_MakeBox(3000.0, 20.0, 10.0).Shape(), STEPControl_AsIs);  // mm
  ASSERT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
  Request request;
  request.parts.emplace_back();
  request.parts[0].model = request.parts[0].path = file;
  try {
    ModelStore().load(request);
    ADD_FAILURE() << "3 m in a bin of 0.4 m";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("the part is 3 m across"), std::string::npos) << text;
    EXPECT_EQ(text.find("\"unit: "), std::string::npos) << text;
  }
  std::filesystem::remove(file);
}

}  // namespace bin_scenes
