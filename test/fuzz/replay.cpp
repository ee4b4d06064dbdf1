/// Runs a fuzzer over the files of its corpus, an archive, in builds without libFuzzer.
#include "fuzz.hpp"

#include <archive.h>
#include <archive_entry.h>

namespace {

int broken(archive* reader, const char* path) {
  std::fprintf(stderr, "%s: %s; unpack it with tar to see more\n", path, archive_error_string(reader));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "one archive is expected, for instance test/fuzz/corpus/mesh.tar.gz\n");
    return 1;
  }
  archive* const reader = archive_read_new();
  archive_read_support_filter_gzip(reader);
  archive_read_support_format_tar(reader);
  if (archive_read_open_filename(reader, argv[1], 1 << 16) != ARCHIVE_OK) return broken(reader, argv[1]);
  std::size_t files = 0;
  archive_entry* entry = nullptr;
  int state = archive_read_next_header(reader, &entry);
  for (; state == ARCHIVE_OK; state = archive_read_next_header(reader, &entry)) {
    std::string bytes(static_cast<std::size_t>(archive_entry_size(entry)), '\0');
    if (archive_read_data(reader, bytes.data(), bytes.size()) != static_cast<la_ssize_t>(bytes.size()))
      return broken(reader, argv[1]);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++files;
  }
  if (state != ARCHIVE_EOF) return broken(reader, argv[1]);
  archive_read_free(reader);
  std::printf("%zu files\n", files);
  return files > 0 ? 0 : 1;
}
