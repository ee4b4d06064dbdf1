#include "bop/writer.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bop/samples.hpp"
#include "output/output_fixture.hpp"
#include "output/read_png.hpp"
#include "output/tiff.hpp"

#include <nlohmann/json.hpp>

namespace bin_scenes {
namespace {

using Json = nlohmann::json;

class Bop : public OutputTest {
 protected:
  static PartModelPtr box(double edge) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
      mesh.vertices.push_back(edge * (Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return PartModel::from_mesh(mesh, "box");
  }
  Json json(const std::string& name) const { return Json::parse(text(name)); }

  const PartModelPtr bolt = box(0.02), nut = box(0.01);
};

TEST_F(Bop, PosesAreThoseOfTheCameraInMillimetres) {
  Scene scene = small_scene();
  scene.parts[2].pose.position = Vec3(0.1, -0.2, 0.4);  // right below the camera
  scene.parts[2].pose.orientation = Quat::Identity();
  write_bop(dir.string(), scene, {bolt, nut}, {small_image()});
  const Json part = json("scene_gt.json").at("0").at(2);
  EXPECT_EQ(part.at("obj_id"), 1);
  EXPECT_EQ(part.at("id"), 2);
  const double expected_t[3] = {0, 0, 500};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(part.at("cam_t_m2c").at(i).get<double>(), expected_t[i], 1e-9);
  const double expected_r[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};  // camera turned by 180 degrees about x
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(part.at("cam_R_m2c").at(i).get<double>(), expected_r[i], 1e-12);
}

TEST_F(Bop, RotationsAreRowMajorAndMapModelPointsIntoTheCamera) {
  const Scene scene = small_scene();
  const RangeImage image = small_image();
  write_bop(dir.string(), scene, {bolt, nut}, {image});
  const Json gt = json("scene_gt.json").at("0");
  ASSERT_EQ(gt.size(), 3u);
  const Vec3 point(0.01, 0.02, 0.03);
  for (int id = 0; id < 3; ++id) {
    const Vec3 expected = 1e3 * (image.sensor.pose->inverse() * (scene.parts[id].pose * point));
    for (int row = 0; row < 3; ++row) {
      double value = gt.at(id).at("cam_t_m2c").at(row).get<double>();
      for (int column = 0; column < 3; ++column) {
        value += gt.at(id).at("cam_R_m2c").at(3 * row + column).get<double>() * 1e3 * point[column];
      }
      EXPECT_NEAR(value, expected[row], 1e-9);
    }
  }
}

TEST_F(Bop, CameraInfoMasksAndCountsBelongTogether) {
  const RangeImage image = small_image();
  write_bop(dir.string(), small_scene(), {bolt, nut}, {image});
  const Json camera = json("scene_camera.json").at("0");
  EXPECT_EQ(camera.at("cam_K").get<std::vector<double>>(), image.sensor.k);
  const Png depth = read_png(path("depth/000000.png"));
  EXPECT_NEAR(depth.at(3, 0) * camera.at("depth_scale").get<double>(), 1e3 * image.depth[3], 0.05);
  const LoadedImage gray = load_tiff(path("gray/000000.tiff"));
  EXPECT_EQ(gray.width, 8);
  EXPECT_EQ(gray.height, 6);
  EXPECT_EQ(gray.samples.at(0), 110) << "120 (0.5 / 0.6)^(1 / 2.2), as the median of the parts is 0.6";

  const Json info = json("scene_gt_info.json").at("0");
  EXPECT_EQ(info.at(0).at("visib_fract"), 0.5);
  EXPECT_EQ(info.at(0).at("px_count_all"), 24);
  EXPECT_EQ(info.at(0).at("bbox_visib"), Json({1, 0, 1, 5}));
  EXPECT_EQ(info.at(1).at("visib_fract"), 0.0);
  EXPECT_EQ(info.at(1).at("bbox_visib"), Json({-1, -1, -1, -1}));
  EXPECT_EQ(info.at(2).at("bbox_visib"), Json({5, 0, 0, 5}));
  for (int id = 0; id < 3; ++id) {
    const Png mask = read_png(path("mask_visib/000000_00000" + std::to_string(id) + ".png"));
    EXPECT_EQ(mask.depth, 8);
    for (std::size_t i = 0; i < image.label.size(); ++i) {
      EXPECT_EQ(mask.samples[i], image.label[i] == id + 1 ? 255 : 0) << id << " " << i;
    }
  }
}

TEST_F(Bop, APartThatWasNeverPouredIsLeftOutAndIdsStay) {
  Scene scene = small_scene();
  scene.parts.push_back(scene.parts[0]);
  scene.parts[3].id = 3;
  scene.parts[1].state = PartState::not_poured;
  scene.parts[1].pose = Pose::none();
  RangeImage image = small_image();
  image.visible.push_back(0);
  image.total.push_back(5);
  write_bop(dir.string(), scene, {bolt, nut}, {image});
  const Json gt = json("scene_gt.json").at("0");
  ASSERT_EQ(gt.size(), 3u);
  const int ids[] = {0, 3, 2};  // the last one stands where part 1 is missing
  for (int place = 0; place < 3; ++place) {
    EXPECT_EQ(gt.at(place).at("id"), ids[place]);
    const Png mask = read_png(path("mask_visib/000000_00000" + std::to_string(place) + ".png"));
    for (std::size_t i = 0; i < image.label.size(); ++i) {
      ASSERT_EQ(mask.samples[i], image.label[i] == ids[place] + 1 ? 255 : 0) << place << " " << i;
    }
  }
  EXPECT_EQ(text("mask_visib/000000_000003.png"), text("mask_visib/000000_000001.png")) << "under its id as well";
}

TEST_F(Bop, MasksAreOfTheVisibleAndOfTheWholePart) {
  RangeImage image = small_image();
  write_bop(path("seen"), small_scene(), {bolt, nut}, {image});
  EXPECT_FALSE(std::filesystem::exists(path("seen/mask"))) << "there were no silhouettes";
  image.silhouettes.resize(3);
  Silhouette& alone = image.silhouettes[1];
  alone.left = 2, alone.top = 1, alone.width = 3, alone.height = 4;
  for (int row = 0; row < alone.height; ++row) alone.bits.push_back(0b101);
  write_bop(path("all"), small_scene(), {bolt, nut}, {image});
  const Png whole = read_png(path("all/mask/000000_000001.png"));
  const Png visible = read_png(path("all/mask_visib/000000_000001.png"));
  for (std::size_t i = 0; i < image.label.size(); ++i) {
    const std::size_t x = i % 8, y = i / 8;
    EXPECT_EQ(whole.samples[i], y >= 1 && y < 5 && (x == 2 || x == 4) ? 255 : 0) << i;
    EXPECT_EQ(visible.samples[i], 0) << i;
  }
}

TEST_F(Bop, AnEmptyBinHasTheFilesOfAnyOther) {
  Scene scene = small_scene();
  scene.parts.clear();
  RangeImage image = small_image();
  image.label.assign(image.label.size(), 0);
  image.visible.clear();
  image.total.clear();
  const std::vector<RangeImage> images = {image};
  const std::vector<BopImage> bop = bop_images(scene, {}, images, {});
  write_bop_samples(dir.string(), 3, bop);
  for (const char* mask : {"000003_000000.mask.json", "000003_000000.mask_visib.json"}) EXPECT_EQ(text(mask), "{}");
  EXPECT_EQ(text("000003_000000.gt.json"), "[]");
  write_bop(path("folder"), bop);
  for (const char* folder : {"folder/mask", "folder/mask_visib"})
    EXPECT_TRUE(std::filesystem::is_directory(dir / folder));
}

TEST_F(Bop, PixelsBesideTheImageCountToThePart) {
  Scene scene = small_scene();
  scene.parts.resize(1);
  scene.parts[0].pose.orientation = Quat::Identity();
  scene.parts[0].pose.position = Vec3(0.1 - 0.5 * 0.4, -0.2, 0.4);  // its middle lies over the left edge, 4 pixels off
  RangeImage image = small_image();
  for (std::uint16_t& label : image.label) label = label == 1 ? 1 : 0;
  image.visible = {12};
  image.total = {12};
  image.silhouettes.resize(1);
  image.silhouettes[0] = {1, 0, 2, 6, 12, std::vector<std::uint64_t>(6, 0b11)};
  write_bop(dir.string(), scene, {box(0.08)}, {image});
  const Json info = json("scene_gt_info.json").at("0").at(0);
  // 10 pixels / 0.46 m x 0.08 m = 1.7 pixels wide around column -0.9 and row 2.5, where pixels have whole numbers.
  EXPECT_EQ(info.at("px_count_all"), 12 + 1 * 2) << info;
  EXPECT_EQ(info.at("px_count_visib"), 12);
  EXPECT_EQ(info.at("px_count_valid"), 12);
}

/// A colour image lies in rgb/, too; the upper eight of sixteen bits.
TEST_F(Bop, ColoursAreInRgb) {
  RangeImage image = small_image();
  image.sensor.model = "image";
  image.sensor.settings.of<ImageSettings>().colour = true;
  image.picture.channels = 3, image.picture.bits = 16;
  for (int i = 0; i < 3 * image.width * image.height; ++i)
    image.picture.counts.push_back(static_cast<std::uint16_t>(i * 100));
  write_bop(dir.string(), small_scene(), {bolt, nut}, {image});
  const Png rgb = read_png(path("rgb/000000.png"));
  EXPECT_EQ(rgb.channels, 3);
  EXPECT_EQ(rgb.depth, 8);
  for (std::size_t i = 0; i < rgb.samples.size(); ++i) ASSERT_EQ(rgb.samples[i], image.picture.counts[i] >> 8);
  EXPECT_TRUE(std::filesystem::exists(path("gray/000000.tiff")));
}

/// Such a file is refused before the memory of the image that it tells of is taken.
TEST_F(Bop, ATiffWithADamagedSizeIsRefused) {
  const int width = 40, height = 30;
  const Bytes whole = tiff8(width, height, 1, std::vector<std::uint8_t>(width * height, 7));
  const auto directory = static_cast<std::size_t>(whole[4] | whole[5] << 8);
  for (const std::size_t at : {directory + 2 + 8, directory + 2 + 12 + 8}) {  // values of the first two entries
    Bytes broken = whole;
    broken[at + 3] = 0x70;
    std::ofstream(path("broken.tiff"), std::ios::binary)
        .write(reinterpret_cast<const char*>(broken.data()), static_cast<std::streamsize>(broken.size()));
    EXPECT_THROW(load_tiff(path("broken.tiff")), Error);
  }
}

TEST_F(Bop, WhatIsNoPinholeImageIsRefused) {
  RangeImage image = small_image();
  image.sensor.distortion[0] = 0.1;
  EXPECT_THROW(write_bop(dir.string(), small_scene(), {bolt, nut}, {image}), Error);
  image.sensor.distortion[0] = 0.0;
  image.sensor.model = "laser_line";
  EXPECT_THROW(write_bop(dir.string(), small_scene(), {bolt, nut}, {image}), Error);
}

TEST_F(Bop, MasksOfAnySizeReadBackAsTheyWere) {
  Random random(5, 0, Stream::probe);
  for (int round = 0; round < 200; ++round) {
    const int width = 1 + static_cast<int>(random.below(round < 190 ? 40 : 900)),
              height = 1 + static_cast<int>(random.below(round < 190 ? 30 : 700));
    MaskBox box;
    box.left = static_cast<int>(random.below(static_cast<std::uint64_t>(width)));
    box.top = static_cast<int>(random.below(static_cast<std::uint64_t>(height)));
    box.width = static_cast<int>(random.below(static_cast<std::uint64_t>(width - box.left + 1)));
    box.height = static_cast<int>(random.below(static_cast<std::uint64_t>(height - box.top + 1)));
    const double change = random.uniform();
    bool in = false;
    for (int i = 0; i < box.width * box.height; ++i) box.inside.push_back(in ^= random.uniform() < change * change);
    const Bytes bytes = mask_png(width, height, box);
    write_bytes(path("mask.png"), bytes);
    const Png mask = read_png(path("mask.png"));
    ASSERT_EQ(mask.width, width);
    ASSERT_EQ(mask.height, height);
    ASSERT_EQ(mask.depth, 8);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int column = x - box.left, row = y - box.top;
        const bool inside = column >= 0 && row >= 0 && column < box.width && row < box.height &&
                            box.inside[static_cast<std::size_t>(row) * box.width + column];
        ASSERT_EQ(mask.at(x, y), inside ? 255 : 0) << round << ": " << x << " " << y;
      }
    }
  }
}

TEST_F(Bop, LinesOfOneModelShareAnObject) {
  EXPECT_EQ(bop_object_ids({bolt, nut, bolt}), (std::vector<int>{1, 2, 1}));
  write_bop_models(path("models"), {bolt, nut, bolt});
  const Json info = json("models/models_info.json");
  EXPECT_EQ(info.size(), 2u);
  EXPECT_NEAR(info.at("1").at("size_x").get<double>(), 20.0, 1e-9);
  EXPECT_NEAR(info.at("1").at("diameter").get<double>(), 20.0 * std::sqrt(3.0), 1e-9);
  EXPECT_TRUE(std::filesystem::exists(dir / "models/obj_000002.ply"));
}

}  // namespace
}  // namespace bin_scenes
