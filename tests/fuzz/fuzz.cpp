// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzers for each task of the reading program, and for what the main program makes of its answers:
// stylet_fuzz --target=NAME [OPTION OF LIBFUZZER…] FOLDER… With --list it prints the name of each target, and of that
// whose first inputs are its own. Whatever the bytes of a file are, a parser must answer within the limits of the
// reading program; an exception that it lets out is a fault, though the reading program would catch it.
#include "child.hpp"
#include "library_faults.hpp"
#include "reading/table.hpp"
#include "reading/tasks.hpp"
#include "scenario/toml_document.hpp"
#include "scenario/toml_precheck.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/found_seeds_io.hpp"
#include "stylet/io/implant_record_io.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "targets.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <gmshc.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <new>
#include <optional>

using namespace stylet;
namespace fs = std::filesystem;

namespace {

constexpr double kPatience_s = 10.0;  // processor time for one file
constexpr const char* kGmsh = "libgmsh.so.4.8";
constexpr std::size_t kLargestBlock = 256U << 20;  // [bytes] of memory; that of the reading program ends later

struct Fuzzer {
  detail::TaskTable table = detail::all_tasks();
  fuzz::Target target;
  fs::path folder;  ///< in memory, with the file that is parsed

  ~Fuzzer() { fs::remove_all(folder); }
};

std::optional<Fuzzer> fuzzer;

/// A reader of the main program: that of a table, or one that looks into an answer. An exception ends the program.
struct Reader {
  const char* name;
  const char* seeds;
  void (*read)(const fs::path&);
};

constexpr std::array kReaders{
    Reader{"read_scenario", "parse_toml_text", [](const fs::path& path) { (void)read_scenario(path); }},
    Reader{"read_motion_csv", "parse_csv_lines", [](const fs::path& path) { (void)read_motion_csv(path); }},
    Reader{"read_points", "parse_csv_lines", [](const fs::path& path) { (void)read_points(path); }},
    Reader{"read_goals", "parse_csv_lines", [](const fs::path& path) { (void)read_goals(path); }},
    Reader{"read_found_seeds", "parse_plan_text", [](const fs::path& path) { (void)read_found_seeds(path); }},
    Reader{"read_recording", "parse_run_file", [](const fs::path& path) { (void)read_recording(path); }},
    Reader{"read_recording_heads", "parse_run_file",
           [](const fs::path& path) { (void)read_recording_heads(std::span(&path, 1)); }},
    Reader{"read_implant_record", "parse_implant_file", [](const fs::path& path) { (void)read_implant_record(path); }},
};

std::vector<fuzz::Target> all_targets() {
  std::vector<fuzz::Target> all;
  for (const Reader& reader : kReaders)
    all.push_back({.name = reader.name, .task = reader.name, .seeds = reader.seeds});
  for (const std::string& task : detail::all_tasks().names())
    for (fuzz::Target& target : fuzz::targets_of(task)) all.push_back(std::move(target));
  return all;
}

void start(const std::string& name) {
  for (const fuzz::Target& target : all_targets()) {
    if (target.name != name) continue;
    std::string folder = "/dev/shm/stylet-fuzz-XXXXXX";
    if (::mkdtemp(folder.data()) == nullptr) break;
    fuzzer.emplace();
    fuzzer->target = target;
    constexpr int kMost = 64 << 20;  // [bytes] that HDF5 keeps for later: to get them anew would take most of the time
    H5set_free_list_limits(kMost, kMost, kMost, kMost, kMost, kMost);
    fuzzer->folder = folder;
    detail::answer_here(
        [](std::string_view task, std::string_view arguments) { return fuzzer->table.answer(task, arguments); });
    return;
  }
  std::cerr << "There is no target '" << name << "', or no folder can be made in /dev/shm.\n";
  std::exit(2);
}

/// Writes a new file in the place of the last one: HDF5 answers from what it still knows of one with the same number.
void put(const fs::path& path, std::string_view bytes) {
  ::unlink(path.c_str());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool whole = file >= 0 && ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  if (!whole || ::close(file) != 0) std::exit(2);
}

/// Lets the libraries forget the file, as the reading program does by its end: gmsh would add the next mesh to it, and
/// HDF5 keeps open what it could not close of a damaged file.
void forget() {
  const detail::FileKind kind = fuzzer->target.kind;
  if (kind == detail::FileKind::gmsh || kind == detail::FileKind::medit) {
    static void* const gmsh = ::dlopen(kGmsh, RTLD_LAZY | RTLD_LOCAL);
    int error = 0;
    reinterpret_cast<decltype(&gmshLoggerStop)>(::dlsym(gmsh, "gmshLoggerStop"))(&error);
    reinterpret_cast<decltype(&gmshClear)>(::dlsym(gmsh, "gmshClear"))(&error);
  }
  // Seldom: HDF5 may fail where it closes a damaged file, which the reading program never asks for.
  constexpr ssize_t kMostOpen = 200;
  if (H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) > kMostOpen) H5close();
}

/// Writes the file. @return path that the request names
fs::path written(std::string_view input) {
  const fuzz::Target& target = fuzzer->target;
  const fs::path path = fuzzer->folder / ("input" + target.ending);
  if (target.kind == detail::FileKind::tetgen) {
    const std::size_t end = std::min(input.find(fuzz::kBetweenFiles), input.size());
    put(path, input.substr(0, end));
    put(fs::path(path).replace_extension(".ele"), input.substr(std::min(end + 1, input.size())));
  } else {
    put(path, input);
  }
  return target.task == detail::kOnlyPatient.name ? fuzzer->folder : path;
}

/// How many faults of the library that reads the files a process may have before the one that ends it; none if it need
/// not end.
std::optional<int> faults_of_process() {
  constexpr int kPly = 100;  // VTK's reader faults at every other file, mostly before it has written anything
  switch (fuzzer->target.kind) {
    case detail::FileKind::ply:
      return kPly;
    case detail::FileKind::gmsh:
    case detail::FileKind::medit:
    case detail::FileKind::obj:
    case detail::FileKind::glb:
    case detail::FileKind::vtk_legacy:
    case detail::FileKind::vtu:
      return 0;
    default:
      break;
  }
  const std::string& seeds = fuzzer->target.seeds;
  return seeds == "parse_run_file" || seeds == "parse_implant_file" ? std::optional(0) : std::nullopt;
}

/// The libraries that are slow to start are started once, before the first child.
void prepare() {
  const detail::FileKind kind = fuzzer->target.kind;
  if (kind == detail::FileKind::gmsh || kind == detail::FileKind::medit) ::dlopen(kGmsh, RTLD_LAZY | RTLD_LOCAL);
  H5open();
}

double processor_time_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// The names of these functions are in the report of a finding.
[[noreturn]] void a_parser_let_an_exception_out() { std::abort(); }
[[noreturn]] void a_parser_took_too_long() { std::abort(); }

bool is_of_exception(const std::string& answer, const fs::path& path) {
  detail::WireReader wire(answer);
  char good = 0;
  wire(good);
  if (good == 1) return false;
  Error error;
  wire(error);
  return error.what == detail::threw(path, "").what;
}

void run(std::string_view input, std::string path) {
  const fuzz::Target& target = fuzzer->target;
  for (const Reader& reader : kReaders)
    if (target.name == reader.name) return reader.read(path);
  if (target.task == detail::kToml.name && !detail::precheck_toml(input, path)) return;
  if (target.kind != detail::FileKind::unknown) {  // the main program asks for no other
    const Result<detail::FileKind> kind = detail::identify(path);
    if (!kind || *kind != target.kind) return;
  }
  detail::WireWriter wire;
  wire(path);
  const std::string answer = fuzzer->table.answer(target.task, wire.bytes + fuzz::arguments_of(target, input));
  if (is_of_exception(answer, path)) a_parser_let_an_exception_out();
}

}  // namespace

// HDF5 reads again and again, with pauses, what has a wrong checksum, as it may be in the middle of being written.
extern "C" [[gnu::visibility("default")]] int nanosleep(const timespec*, timespec*) { return 0; }

// All checksums in an HDF5 file count as right. Nearly every change makes one wrong, and HDF5 would read no further.
extern "C" [[gnu::visibility("default")]] herr_t H5F_get_checksums(const std::uint8_t*, std::size_t,
                                                                   std::uint32_t* stored, std::uint32_t* computed) {
  if (stored != nullptr) *stored = 0;
  if (computed != nullptr) *computed = 0;
  return 0;
}

// Blocks that are too large are refused by an exception, as they are in the reading program. The sanitizer's own
// operator would end the program.
void* operator new(std::size_t size) {
  void* const block = size <= kLargestBlock ? std::malloc(size) : nullptr;
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return size <= kLargestBlock ? std::malloc(size) : nullptr;
}
void* operator new[](std::size_t size, const std::nothrow_t& none) noexcept { return operator new(size, none); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { std::free(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { std::free(block); }

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  const std::string_view option = "--target=";
  for (int k = 1; k < *count; ++k) {
    const std::string argument = (*arguments)[k];
    if (argument == "--list") {
      for (const fuzz::Target& target : all_targets()) std::cout << target.name << " " << target.seeds << "\n";
      std::cout.flush();
      std::_Exit(0);
    }
    if (argument.starts_with(option)) start(argument.substr(option.size()));
  }
  if (!fuzzer) {
    std::cerr << "usage: stylet_fuzz --list | --target=NAME [OPTION OF LIBFUZZER…] FOLDER…\n";
    std::_Exit(2);
  }
  if (faults_of_process()) {
    fuzz::keep_stderr_for_children();
    // No thread beside this one, which could hold a lock when a child is made.
    static std::vector<char*> all;
    static std::string no_watch = "-rss_limit_mb=0";
    all.assign(*arguments, *arguments + *count);
    all.push_back(no_watch.data());
    all.push_back(nullptr);
    *arguments = all.data();
    ++*count;
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  [[maybe_unused]] static const bool ready = (fuzz::pass_over_known_faults(), prepare(), true);
  const auto read = [](std::string_view input) {
    const double start_s = processor_time_s();
    if (sigsetjmp(fuzz::after_known_fault, 1) == 0) {
      run(input, written(input));
      forget();
    }
    if (processor_time_s() - start_s > kPatience_s) a_parser_took_too_long();
  };
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  if (const auto faults = faults_of_process())
    fuzz::run_in_child(input, *faults, read);
  else
    read(input);
  return 0;
}
