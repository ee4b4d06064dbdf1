/// The statements of SQLite behind each question, in one place. Every heap is one transaction.
#include "dataset/scene_index.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"

#include <sqlite3.h>

#include <cstdlib>

namespace bin_scenes {

namespace {

// Texts only: one method to bind and to read them serves all. Sorting and sums cast.
constexpr const char* schema[] = {
    "create table if not exists heaps (heap integer primary key, state text, attempts integer, wall_s real, "
    "cpu_s real, memory_mb real, stages_ms text, made_at text default (datetime('now')))",
    "create table if not exists scenes (scene integer primary key, heap integer, state text, verdict text, path text, "
    "sha256 text, summary text)",
    "create table if not exists shares (shard integer, shards integer, primary key (shard, shards))",
    "create table if not exists rejected (heap integer, attempt integer, path text, reasons text, "
    "primary key (heap, attempt))",
    "create index if not exists scenes_of_heap on scenes (heap)"};

}  // namespace

SceneIndex::SceneIndex(const std::filesystem::path& path, bool only_read) : path_(path.string()) {
  const int flags = only_read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(path_.c_str(), &database_, flags, nullptr) != SQLITE_OK) {
    const std::string why = sqlite3_errmsg(database_);
    sqlite3_close(database_);
    throw environment_error("cannot be opened: " + why, path_, "check permissions and free space");
  }
  sqlite3_busy_timeout(database_, 10'000);
  if (only_read) return;
  try {
    rows("pragma journal_mode = delete");  // one file at rest, which a reader without rights to write can open
    rows("pragma synchronous = normal");
    for (const char* statement : schema) rows(statement);
  } catch (...) {
    sqlite3_close(database_);
    throw;
  }
}

SceneIndex::~SceneIndex() {
  sqlite3_close(database_);
}

std::vector<std::vector<std::string>> SceneIndex::rows(const std::string& sql,
                                                       const std::vector<std::string>& values) const {
  sqlite3_stmt* statement = nullptr;
  const auto fail = [&] {
    const std::string why = sqlite3_errmsg(database_);
    const int code = sqlite3_errcode(database_);
    sqlite3_finalize(statement);
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB)
      return input_error("is damaged: " + why, path_, "remove it: it is made again from the scenes");
    return environment_error("cannot be used: " + why, path_, "check permissions and free space");
  };
  if (sqlite3_prepare_v2(database_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) throw fail();
  BIN_SCENES_ASSERT(static_cast<std::size_t>(sqlite3_bind_parameter_count(statement)) == values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    sqlite3_bind_text(statement, static_cast<int>(i) + 1, values[i].data(), static_cast<int>(values[i].size()),
                      SQLITE_TRANSIENT);
  std::vector<std::vector<std::string>> all;
  int step;
  while ((step = sqlite3_step(statement)) == SQLITE_ROW) {
    all.emplace_back();
    for (int column = 0; column < sqlite3_column_count(statement); ++column) {
      const unsigned char* text = sqlite3_column_text(statement, column);
      all.back().emplace_back(text ? reinterpret_cast<const char*>(text) : "");
    }
  }
  if (step != SQLITE_DONE) throw fail();
  sqlite3_finalize(statement);
  return all;
}

void SceneIndex::forget(std::size_t heap) {
  const std::vector<std::string> of = {std::to_string(heap)};
  for (const char* table : {"heaps", "scenes", "rejected"})
    rows(std::string("delete from ") + table + " where heap = cast(? as integer)", of);
}

void SceneIndex::put(const HeapRecord& record) {
  BIN_SCENES_ASSERT(std::is_sorted(record.scenes.begin(), record.scenes.end(),
                                   [](const SceneRecord& a, const SceneRecord& b) { return a.scene < b.scene; }));
  BIN_SCENES_ASSERT(!record.accepted || !record.scenes.empty());
  rows("begin immediate");
  try {
    forget(record.heap);
    const std::string heap = std::to_string(record.heap);
    rows("insert into heaps (heap, state, attempts, wall_s, cpu_s, memory_mb, stages_ms) values (?, ?, ?, ?, ?, ?, ?)",
         {heap, record.accepted ? "done" : "failed", std::to_string(record.rejected.size() + record.accepted),
          std::to_string(record.wall_s), std::to_string(record.cpu_s), std::to_string(record.memory_mb),
          nlohmann::json(record.stages_ms).dump()});
    for (const SceneRecord& scene : record.scenes)
      rows(
          "insert into scenes (scene, heap, state, verdict, path, sha256, summary) values (?, ?, 'done', 'accepted', "
          "?, ?, ?)",
          {std::to_string(scene.scene), heap, scene.path, scene.sha256, scene.summary.dump()});
    for (const RejectedRecord& rejected : record.rejected)
      rows("insert into rejected (heap, attempt, path, reasons) values (?, ?, ?, ?)",
           {heap, std::to_string(rejected.attempt), rejected.path, nlohmann::json(rejected.reasons).dump()});
    rows("commit");
  } catch (...) {
    sqlite3_exec(database_, "rollback", nullptr, nullptr, nullptr);
    throw;
  }
}

void SceneIndex::add_share(std::size_t shard, std::size_t shards) {
  rows("insert or ignore into shares values (cast(? as integer), cast(? as integer))",
       {std::to_string(shard), std::to_string(shards)});
}

std::set<std::pair<std::size_t, std::size_t>> SceneIndex::shares() const {
  std::set<std::pair<std::size_t, std::size_t>> all;
  for (const auto& row : rows("select shard, shards from shares")) all.emplace(std::stoul(row[0]), std::stoul(row[1]));
  return all;
}

std::set<std::size_t> SceneIndex::heaps() const {
  std::set<std::size_t> all;
  for (const auto& row : rows("select heap from heaps")) all.insert(std::stoul(row[0]));
  return all;
}

IndexCounts SceneIndex::counts() const {
  const auto number = [&](const char* sql) { return std::stoul("0" + rows(sql).at(0).at(0)); };
  IndexCounts counts;
  counts.failed = number("select count(*) from heaps where state = 'failed'");
  counts.scenes = number("select count(*) from scenes");
  counts.rejected = number("select count(*) from rejected");
  counts.timed = number("select count(*) from heaps where wall_s >= 0");
  const auto sums = rows("select total(wall_s), total(cpu_s) from heaps where wall_s >= 0").at(0);
  counts.wall_s = std::strtod(sums[0].c_str(), nullptr);
  counts.cpu_s = std::strtod(sums[1].c_str(), nullptr);
  const auto parts = rows(
                         "select total(json_extract(summary, '$.not_poured')), total(json_extract(summary, "
                         "'$.asked_for')) from scenes "
                         "where scene in (select min(scene) from scenes group by heap)")
                         .at(0);
  counts.not_poured = static_cast<std::size_t>(std::strtod(parts[0].c_str(), nullptr));
  counts.asked_for = static_cast<std::size_t>(std::strtod(parts[1].c_str(), nullptr));
  return counts;
}

std::map<std::string, double> SceneIndex::stages_ms() const {
  std::map<std::string, double> sums;
  for (const auto& row : rows("select stages_ms from heaps")) {
    const nlohmann::json stages = nlohmann::json::parse(row[0]);
    for (const auto& [stage, ms] : stages.items()) sums[stage] += ms.get<double>();
  }
  return sums;
}

void SceneIndex::each_scene(const std::function<void(const Row&)>& visit) const {
  constexpr std::size_t at_once = 1000;  // rows in memory
  for (std::string after = "-1";;) {
    const auto some = rows(
        "select scene, scenes.heap, path, sha256, wall_s, summary from scenes join heaps using (heap) "
        "where scene > cast(? as integer) order by scene limit " +
            std::to_string(at_once),
        {after});
    for (const auto& r : some)
      visit({std::stoul(r[0]), std::stoul(r[1]), r[2], r[3], std::strtod(r[4].c_str(), nullptr),
             nlohmann::json::parse(r[5])});
    if (some.size() < at_once) return;
    after = some.back()[0];
  }
}

std::vector<SceneIndex::Rejected> SceneIndex::rejected() const {
  std::vector<Rejected> all;
  for (const auto& r : rows("select heap, attempt, path, reasons from rejected order by heap, attempt"))
    all.push_back({std::stoul(r[0]), std::stoul(r[1]), r[2], r[3]});
  return all;
}

HeapRecord SceneIndex::record(std::size_t heap) const {
  HeapRecord record;
  record.heap = heap;
  const std::vector<std::string> of = {std::to_string(heap)};
  for (const auto& r :
       rows("select state, wall_s, stages_ms, cpu_s, memory_mb from heaps where heap = cast(? as integer)", of)) {
    record.accepted = r[0] == "done";
    record.wall_s = std::strtod(r[1].c_str(), nullptr);
    record.stages_ms = nlohmann::json::parse(r[2]).get<std::map<std::string, double>>();
    record.cpu_s = std::strtod(r[3].c_str(), nullptr);
    record.memory_mb = std::strtod(r[4].c_str(), nullptr);
  }
  for (const auto& r :
       rows("select scene, path, sha256, summary from scenes where heap = cast(? as integer) order by scene", of))
    record.scenes.push_back({std::stoul(r[0]), r[1], r[2], nlohmann::json::parse(r[3])});
  for (const auto& r :
       rows("select attempt, path, reasons from rejected where heap = cast(? as integer) order by attempt", of))
    record.rejected.push_back({std::stoul(r[0]), r[1], nlohmann::json::parse(r[2])});
  return record;
}

}  // namespace bin_scenes
