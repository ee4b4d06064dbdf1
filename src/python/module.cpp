/// The compiled part of the Python package bin_scenes: requests, scenes and their arrays, streams of scenes, heaps.
/// What users call stands in python/bin_scenes, and its types in python/bin_scenes/_core.pyi.
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/freed_memory.hpp"
#include "bin_scenes/output/image_channel.hpp"
#include "heap_handle.hpp"
#include "scene_data.hpp"
#include "scene_stream.hpp"
#include "session.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <numeric>
#include <optional>

namespace py = pybind11;

namespace bin_scenes::python {

namespace {

/// Python's signal handlers run: Ctrl-C becomes KeyboardInterrupt. Called without the interpreter's lock.
void poll_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Text of a message, which may hold bytes of a file.
py::str text_of(const std::string& bytes) {
  PyObject* text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "backslashreplace");
  if (!text) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const char* const kind = error.kind() == ErrorKind::input         ? "input"
                               : error.kind() == ErrorKind::environment ? "environment"
                                                                        : "cancelled";
      const py::object type = py::module_::import("bin_scenes._error").attr("Error");
      const py::object made =
          type(text_of(error.problem()), text_of(error.where()), text_of(error.remedy()), kind, text_of(error.what()));
      PyErr_SetObject(type.ptr(), made.ptr());
    }
  });
}

bool has_shape(std::size_t count, const std::vector<py::ssize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), py::ssize_t{1}, std::multiplies<>()) ==
         static_cast<py::ssize_t>(count);
}

/// Memory of `owner` as an array, which keeps it alive.
template <class Value>
py::array array_of(std::vector<Value>& values, std::vector<py::ssize_t> shape, py::handle owner) {
  BIN_SCENES_ASSERT(has_shape(values.size(), shape));
  return py::array_t<Value>(std::move(shape), values.data(), owner);
}
template <class Value, std::size_t n>
py::array array_of(std::vector<std::array<Value, n>>& values, std::vector<py::ssize_t> shape, py::handle owner) {
  BIN_SCENES_ASSERT(has_shape(values.size(), shape));
  shape.push_back(n);
  return py::array_t<Value>(std::move(shape), values.empty() ? nullptr : values.front().data(), owner);
}
template <class Value>
py::array copied(const Value* values, std::vector<py::ssize_t> shape) {
  return py::array_t<Value>(std::move(shape), values);
}

/// For __reduce__ of what shows memory of this process.
auto no_pickle(const char* advice) {
  return [advice](py::object self) -> py::object {
    const auto name = self.get_type().attr("__name__").cast<std::string>();
    throw py::type_error("a bin_scenes." + name +
                         " cannot be pickled or copied: its arrays show memory of this process. " + advice);
  };
}

using ImagePtr = std::shared_ptr<ImageData>;
using ScenePtr = std::shared_ptr<SceneData>;

/// As it was measured: rows and columns of the image.
template <class Member>
auto measured(Member member) {
  return [member](py::object self) {
    RangeImage& image = self.cast<ImagePtr>()->image;
    return array_of(image.*member, {image.height, image.width}, self);
  };
}

/// The truth of the camera's own view: its own memory, or where it equals what was measured, that.
template <class Member>
auto truth(Member own, Member same) {
  return [own, same](py::object self) {
    RangeImage& image = self.cast<ImagePtr>()->image;
    return array_of((image.*own).empty() ? image.*same : image.*own, {image.sensor.height, image.sensor.width}, self);
  };
}

template <class Make>
auto cloud(Make make) {
  return [make](py::object self) {
    ImageData& data = *self.cast<ImagePtr>();
    std::vector<std::array<float, 3>>* made = nullptr;
    {
      const py::gil_scoped_release computing;
      made = &(data.*make)();
    }
    return array_of(*made, {data.image.height, data.image.width}, self);
  };
}

/// What a camera took; None of the other models.
py::object picture(py::object self) {
  ImageData& data = *self.cast<ImagePtr>();
  Picture& taken = data.image.picture;
  if (taken.channels == 0) return py::none();
  std::vector<py::ssize_t> shape = {data.image.height, data.image.width};
  if (taken.channels > 1) shape.push_back(taken.channels);
  return taken.bits == 8 ? array_of(data.picture_bytes(), shape, self) : array_of(taken.counts, shape, self);
}

/// The grey image; None of a range sensor whose grey image was not asked for.
py::object gray(py::object self) {
  ImageData& data = *self.cast<ImagePtr>();
  if (!data.has_gray()) return py::none();
  return array_of(data.gray(), {data.image.height, data.image.width}, self);
}

/// As the files of the command line hold it; None where the image has no such channel.
py::object channel(const ImageData& data, const std::string& name) {
  const ImageChannel* found = find_image_channel(name);
  if (!found) {
    std::string known;
    for (const ImageChannel& other : image_channels()) known += (known.empty() ? "" : ", ") + other.name;
    throw input_error("an image has no channel of this name", name, "take one of " + known);
  }
  const Picture made = found->counts(data.image);
  if (made.channels == 0) return py::none();
  std::vector<py::ssize_t> shape = {found->height(data.image), found->width(data.image)};
  if (made.channels > 1) shape.push_back(made.channels);
  if (made.bits == 16) return copied(made.counts.data(), shape);
  return copied(std::vector<std::uint8_t>(made.counts.begin(), made.counts.end()).data(), shape);
}

void bind_image(py::module_& m) {
  py::class_<ImageData, ImagePtr>(m, "Image")
      .def("__reduce__", no_pickle("Send arrays that you need of it, such as image.depth"))
      .def_property_readonly("name", [](const ImageData& i) { return i.image.sensor.name; })
      .def_property_readonly("width", [](const ImageData& i) { return i.image.width; })
      .def_property_readonly("height", [](const ImageData& i) { return i.image.height; })
      .def_property_readonly("depth_scale", [](const ImageData& i) { return i.image.sensor.depth_scale; })
      .def_property_readonly("K",
                             [](const ImageData& i) {
                               return copied(i.image.sensor.k.data(), {3, 3});
                             })
      .def_property_readonly("distortion",
                             [](const ImageData& i) { return copied(i.image.sensor.distortion.data(), {5}); })
      .def_property_readonly("pose",
                             [](const ImageData& i) {
                               const Pose pose = i.image.sensor.pose.value_or(Pose());
                               const Quat& q = pose.orientation;
                               const Vec3& at = pose.position;
                               const double all[] = {at.x(), at.y(), at.z(), q.x(), q.y(), q.z(), q.w()};
                               return copied(all, {7});
                             })
      .def_property_readonly("depth", measured(&RangeImage::depth))
      .def_property_readonly("label", measured(&RangeImage::label))
      .def_property_readonly("intensity", measured(&RangeImage::intensity))
      .def_property_readonly("snr", measured(&RangeImage::snr))
      .def_property_readonly("validity", measured(&RangeImage::validity))
      .def_property_readonly("picture", picture)
      .def_property_readonly("gray", gray)
      .def("channel", channel, py::arg("name"))
      .def_property_readonly("points", cloud(&ImageData::points))
      .def_property_readonly("normals", cloud(&ImageData::normals))
      .def_property_readonly("truth_depth", truth(&RangeImage::truth_depth, &RangeImage::depth))
      .def_property_readonly("truth_label", truth(&RangeImage::truth_label, &RangeImage::label))
      .def_property_readonly("truth_normals", truth(&RangeImage::truth_normal, &RangeImage::normal))
      .def_property_readonly("visible_pixels",
                             [](const ImageData& i) {
                               const std::vector<std::int64_t> n(i.image.visible.begin(), i.image.visible.end());
                               return copied(n.data(), {static_cast<py::ssize_t>(n.size())});
                             })
      .def_property_readonly("total_pixels", [](const ImageData& i) {
        const std::vector<std::int64_t> n(i.image.total.begin(), i.image.total.end());
        return copied(n.data(), {static_cast<py::ssize_t>(n.size())});
      });
}

/// One number a part, or one row.
template <class Values>
auto by_part(Values SceneData::*member) {
  return [member](py::object self) {
    SceneData& scene = *self.cast<ScenePtr>();
    return array_of(scene.*member, {static_cast<py::ssize_t>(scene.scene.parts.size())}, self);
  };
}

py::dict visible_fraction(const SceneData& scene) {
  py::dict all;
  for (const auto& image : scene.images) {
    const std::string& name = image->image.sensor.name;
    std::vector<double> fractions;
    for (const ScenePart& part : scene.scene.parts) {
      const auto found = part.visible_fraction.find(name);
      fractions.push_back(found == part.visible_fraction.end() ? 0.0 : found->second);
    }
    all[py::str(name)] = copied(fractions.data(), {static_cast<py::ssize_t>(fractions.size())});
  }
  return all;
}

void bind_scene(py::module_& m) {
  py::class_<SceneData, ScenePtr>(m, "Scene")
      .def("__reduce__", no_pickle("Send what you need of it, such as {'poses': scene.poses, 'json': scene.json()}"))
      .def_property_readonly("seed", [](const SceneData& s) { return s.scene.seed; })
      .def_property_readonly("index", [](const SceneData& s) { return s.scene.index; })
      .def_property_readonly("accepted", [](const SceneData& s) { return s.scene.report.accepted; })
      .def_property_readonly("at_rest", [](const SceneData& s) { return s.scene.report.at_rest; })
      .def_property_readonly("poses", by_part(&SceneData::poses))
      .def_property_readonly("velocities", by_part(&SceneData::velocities))
      .def_property_readonly("ids", by_part(&SceneData::ids))
      .def_property_readonly("lines", by_part(&SceneData::lines))
      .def_property_readonly("models",
                             [](const SceneData& s) {
                               py::list models;
                               for (const ScenePart& part : s.scene.parts) models.append(text_of(part.model));
                               return models;
                             })
      .def_property_readonly("states",
                             [](const SceneData& s) {
                               py::list states;
                               for (const ScenePart& part : s.scene.parts) states.append(name_of(part.state));
                               return states;
                             })
      .def_property_readonly("visible_fraction", visible_fraction)
      .def_property_readonly("images",
                             [](const SceneData& s) {
                               py::dict images;
                               for (const auto& image : s.images) images[py::str(image->image.sensor.name)] = image;
                               return images;
                             })
      .def_property_readonly("report",
                             [](const SceneData& s) -> py::object {
                               return py::module_::import("json").attr("loads")(report_text(s.scene.report));
                             })
      .def_property_readonly("grasps",
                             [](const SceneData& s) -> py::object {
                               if (!s.grasps) return py::none();
                               return py::module_::import("json").attr("loads")(text_of(s.grasps_json()));
                             })
      .def("json", [](const SceneData& s) {
        std::string text;
        {
          const py::gil_scoped_release computing;
          text = s.json();
        }
        return text_of(text);
      });
}

/// Without the interpreter's lock also where Python drops it: its end may wait for the session's thread.
struct Scenes {
  std::unique_ptr<SceneStream> stream;
  ~Scenes() { close(); }
  void close() {
    const py::gil_scoped_release waiting;
    stream->stop();
  }
};

void bind_scenes(py::module_& m) {
  py::class_<Scenes>(m, "Scenes")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__",
           [](Scenes& scenes) {
             ScenePtr scene;
             {
               const py::gil_scoped_release waiting;
               scene = scenes.stream->next(poll_signals);
             }
             if (!scene) throw py::stop_iteration();
             return scene;
           })
      .def_property_readonly("ready", [](const Scenes& scenes) { return scenes.stream->ready(); })
      .def("close", &Scenes::close);
}

using SessionPtr = std::shared_ptr<Session>;

/// Likewise.
struct SessionHolder {
  SessionPtr session = Session::open();
  ~SessionHolder() {
    const py::gil_scoped_release waiting;
    session.reset();
  }
};

void bind_session(py::module_& m) {
  py::class_<SessionHolder>(m, "Session")
      .def(py::init<>())
      .def("refuse_if_closed", [](const SessionHolder& own) { own.session->refuse_if_closed("Generator"); })
      .def("close",
           [](SessionHolder& own) {
             const py::gil_scoped_release waiting;
             own.session->close();
           })
      .def(
          "generate",
          [](const SessionHolder& own, const Request& request, std::size_t ahead, bool images, bool grasps, bool gray) {
            return std::unique_ptr<Scenes>(
                new Scenes{std::make_unique<SceneStream>(own.session, request, ahead, Wanted{images, grasps, gray})});
          })
      .def("heap", [](const SessionHolder& own, const Request& request) {
        const py::gil_scoped_release waiting;
        return std::make_unique<HeapHandle>(own.session, request, poll_signals);
      });
}

void bind_heap(py::module_& m) {
  const auto waiting = py::call_guard<py::gil_scoped_release>();
  py::class_<HeapHandle>(m, "Heap")
      .def(
          "settle", [](HeapHandle& heap) { return heap.settle(poll_signals); }, waiting)
      .def(
          "remove", [](HeapHandle& heap, const std::vector<int>& ids) { heap.remove(ids, poll_signals); }, waiting)
      .def(
          "lift",
          [](HeapHandle& heap, const std::vector<int>& ids, const std::array<double, 3>& direction, double distance) {
            heap.lift(ids, Vec3(direction[0], direction[1], direction[2]), distance, poll_signals);
          },
          waiting)
      .def(
          "add",
          [](HeapHandle& heap, const std::vector<Request>& requests) {
            std::vector<PartLine> lines;
            for (const Request& one : requests) lines.insert(lines.end(), one.parts.begin(), one.parts.end());
            return heap.add(lines, poll_signals);
          },
          waiting)
      .def(
          "set_gravity",
          [](HeapHandle& heap, const std::array<double, 3>& g) {
            heap.set_gravity(Vec3(g[0], g[1], g[2]), poll_signals);
          },
          waiting)
      .def(
          "scene",
          [](HeapHandle& heap, bool images, bool grasps, bool gray) {
            return heap.scene(Wanted{images, grasps, gray}, poll_signals);
          },
          waiting);
}

using Assignments = std::vector<std::pair<std::string, std::string>>;

std::vector<Override> overrides_of(const Assignments& assignments) {
  std::vector<Override> overrides;
  for (const auto& [assignment, origin] : assignments) overrides.emplace_back(assignment, origin);
  return overrides;
}

/// A request that never was a file has no line numbers to report.
Request read_text(const std::string& yaml, const Assignments& assignments) {
  try {
    return read_request_text(yaml, ".", overrides_of(assignments));
  } catch (const Error& error) {
    const std::string file = "request:";
    if (error.where().rfind(file, 0) != 0) throw;
    throw Error(error.kind(), error.problem(), "request", error.remedy());
  }
}

}  // namespace

}  // namespace bin_scenes::python

PYBIND11_MODULE(_core, m) {
  using namespace bin_scenes;
  using namespace bin_scenes::python;
  keep_freed_memory();  // as the command line: images of a megapixel take a fifth less time
  m.attr("__version__") = BIN_SCENES_VERSION;
  translate_errors();
  py::class_<Request>(m, "Request").def_readonly("scenes", &Request::scenes);
  const auto waiting = py::call_guard<py::gil_scoped_release>();
  m.def(
      "read_file",
      [](const std::string& path, const Assignments& assignments) {
        return read_request(path, overrides_of(assignments));
      },
      waiting);
  m.def("read_text", &read_text, waiting);
  bind_image(m);
  bind_scene(m);
  bind_scenes(m);
  bind_session(m);
  bind_heap(m);
  py::module_::import("atexit").attr("register")(
      py::cpp_function(&close_sessions, py::call_guard<py::gil_scoped_release>()));
}
