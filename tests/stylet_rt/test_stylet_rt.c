/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tests the C interface from C. Usage: test_stylet_rt CLAIM FOLDER   with the files of save_box in FOLDER */
#define _DEFAULT_SOURCE

#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stylet/stylet_rt.h>
#if defined(__linux__)
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#endif
#if defined(__SSE2__)
#include <emmintrin.h>
enum { FLUSHES = 1, FTZ_DAZ = 0x8040 };
#elif defined(__aarch64__)
enum { FLUSHES = 1 };
#else
enum { FLUSHES = 0 };
#endif

enum { SKIPPED = 77, POINTS = 33, MOST_CONTACTS = 256 };

long allocations_so_far(void); /* allocations.cpp */

static int failures = 0;
static const char* folder = NULL;

#define CHECK(condition) check((condition) != 0, #condition, __LINE__)

static void check(int holds, const char* condition, int line) {
  if (holds) return;
  ++failures;
  fprintf(stderr, "line %d: %s does not hold\n", line, condition);
}

static const char* in_folder(const char* name) {
  static char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static stylet_rt_model* loaded(void) {
  stylet_rt_model* model = NULL;
  char error[512];
  if (stylet_rt_model_load(in_folder("box.stylet"), NULL, 0, &model, error, sizeof error) != STYLET_RT_OK) {
    fprintf(stderr, "%s\n", error);
    exit(1);
  }
  CHECK(error[0] == '\0');
  return model;
}

static stylet_rt_sim* created(const stylet_rt_model* model, int32_t insertion) {
  stylet_rt_sim* sim = NULL;
  stylet_rt_options options;
  char error[512];
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.insertion = insertion;
  if (stylet_rt_sim_create(model, &options, &sim, error, sizeof error) != STYLET_RT_OK) {
    fprintf(stderr, "%s\n", error);
    exit(1);
  }
  return sim;
}

static double time_step(const stylet_rt_model* model) {
  stylet_rt_model_info info;
  CHECK(stylet_rt_model_read_info(model, &info) == STYLET_RT_OK);
  return info.dt_s;
}

static double duration(const stylet_rt_model* model, int32_t insertion) {
  stylet_rt_insertion plan;
  CHECK(stylet_rt_model_insertion(model, insertion, &plan) == STYLET_RT_OK);
  return plan.duration_s;
}

/* Takes step k of a planned insertion. */
static stylet_rt_result stepped(stylet_rt_sim* sim, int k, double dt) {
  stylet_rt_pose base;
  stylet_rt_result result;
  memset(&result, 0, sizeof result);
  CHECK(stylet_rt_sim_planned_base(sim, k * dt, &base) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_step(sim, &base, dt, &result) == STYLET_RT_OK);
  return result;
}

/* Collects the numbers of numbers.hpp through the C interface. @return their number */
static size_t numbers_of(stylet_rt_sim* sim, double dt, double duration_s, double* out) {
  size_t n = 0;
  int k;
  for (k = 1; k * dt < duration_s; ++k) {
    static stylet_rt_contact contacts[MOST_CONTACTS];
    static stylet_rt_event events[STYLET_RT_MAX_EVENTS];
    static double needle[3 * POINTS];
    const stylet_rt_result r = stepped(sim, k, dt);
    size_t contact_count = 0, event_count = 0, c;
    memcpy(out + n, &r, 22 * sizeof(double)); /* time_s ... sliding_share */
    n += 22;
    out[n++] = r.flags;
    out[n++] = r.tip_state;
    out[n++] = r.contacts;
    out[n++] = r.sticking;
    out[n++] = r.iterations;
    CHECK(stylet_rt_sim_read_contacts(sim, contacts, MOST_CONTACTS, &contact_count) == STYLET_RT_OK);
    CHECK(contact_count == (size_t)r.contacts);
    for (c = 0; c < contact_count; ++c) {
      memcpy(out + n, &contacts[c], 8 * sizeof(double)); /* position_mm ... length_mm */
      n += 8;
      out[n++] = contacts[c].sticking;
      out[n++] = contacts[c].tip;
    }
    CHECK(stylet_rt_sim_read_needle(sim, needle, POINTS) == STYLET_RT_OK);
    memcpy(out + n, needle, sizeof needle);
    n += 3 * POINTS;
    CHECK(stylet_rt_sim_read_events(sim, events, STYLET_RT_MAX_EVENTS, &event_count) == STYLET_RT_OK);
    CHECK(event_count == (size_t)r.events);
    for (c = 0; c < event_count; ++c) {
      memcpy(out + n, &events[c], 3 * sizeof(double)); /* time_s ... force_N */
      n += 3;
      out[n++] = events[c].kind;
      out[n++] = events[c].region;
    }
  }
  return n;
}

/* Reads a whole file in the folder. @return its bytes, to be freed */
static void* read_file(const char* name, size_t* size) {
  FILE* file = fopen(in_folder(name), "rb");
  void* bytes;
  if (file == NULL) exit(1);
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  bytes = malloc(*size);
  if (bytes == NULL || fread(bytes, 1, *size, file) != *size) exit(1);
  fclose(file);
  return bytes;
}

static int its_numbers_are_those_of_the_interface_in_cpp_to_the_last_bit(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = created(model, 0);
  size_t size = 0, count;
  double* expected = read_file("box.numbers", &size);
  const size_t expected_count = size / sizeof *expected;
  double* numbers = malloc((2 * expected_count + 10000) * sizeof *numbers);
  if (numbers == NULL) return 1;
  count = numbers_of(sim, time_step(model), duration(model, 0), numbers);
  CHECK(stylet_rt_sim_place(sim, 1) == STYLET_RT_OK);
  count += numbers_of(sim, time_step(model), duration(model, 1), numbers + count);
  CHECK(count == expected_count);
  CHECK(count > 10000);
  CHECK(memcmp(numbers, expected, expected_count * sizeof *numbers) == 0);
  free(numbers);
  free(expected);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return 0;
}

static int two_simulations_share_a_model(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* one = created(model, 0);
  stylet_rt_sim* two = created(model, 0);
  stylet_rt_sim* other = created(model, 1);
  const double dt = time_step(model);
  double most_N = 0.0;
  int k, apart = 0;
  stylet_rt_model_destroy(model); /* the simulations keep it alive */
  for (k = 1; k < 300; ++k) {
    const stylet_rt_result a = stepped(one, k, dt);
    const stylet_rt_result c = stepped(other, k, dt);
    const stylet_rt_result b = stepped(two, k, dt);
    CHECK(memcmp(&a, &b, sizeof a) == 0);
    apart += memcmp(&a, &c, sizeof a) != 0;
    most_N = fmax(most_N, a.force_axial_N);
  }
  CHECK(apart == 299);
  CHECK(most_N > 0.3);
  stylet_rt_sim_destroy(one);
  stylet_rt_sim_destroy(two);
  stylet_rt_sim_destroy(other);
  return 0;
}

static void check_refused(const char* name, const char* word) {
  static char some_place;
  stylet_rt_model* model = (stylet_rt_model*)&some_place;
  char error[1024], cut[8];
  CHECK(stylet_rt_model_load(in_folder(name), NULL, 0, &model, error, sizeof error) == STYLET_RT_INPUT_ERROR);
  CHECK(model == NULL);
  CHECK(strstr(error, name) != NULL);
  CHECK(strstr(error, word) != NULL);
  CHECK(strstr(error, "stylet prepare") != NULL);
  memset(cut, 'x', sizeof cut);
  CHECK(stylet_rt_model_load(in_folder(name), NULL, 0, &model, cut, 5) == STYLET_RT_INPUT_ERROR);
  CHECK(strncmp(cut, error, 4) == 0 && cut[4] == '\0' && cut[5] == 'x');
  CHECK(stylet_rt_model_load(in_folder(name), NULL, 0, &model, NULL, 0) == STYLET_RT_INPUT_ERROR);
}

static int files_that_are_no_model_are_refused_with_place_and_cure(void) {
  check_refused("none.stylet", "no such file");
  check_refused("cut.stylet", "truncated or damaged");
  check_refused("text.stylet", "not a saved model");
  return 0;
}

/* Number of flips: STYLET_FLIPS in the environment, else a sample. */
static int a_file_with_any_bit_changed_is_refused(void) {
  const char* wanted = getenv("STYLET_FLIPS");
  const int flips = wanted == NULL ? 100 : atoi(wanted);
  size_t size = 0;
  unsigned char* bytes = read_file("box.stylet", &size);
  int k;
  srand(20051026);
  for (k = 0; k < flips; ++k) {
    const size_t at = (size_t)(((double)rand() / RAND_MAX) * (double)(size - 1));
    const unsigned char bit = (unsigned char)(1 << (rand() % 8));
    FILE* file = fopen(in_folder("flipped.stylet"), "wb");
    bytes[at] ^= bit;
    CHECK(file != NULL && fwrite(bytes, 1, size, file) == size);
    fclose(file);
    check_refused("flipped.stylet", at < 8 ? "not a saved model" : "stylet prepare");
    bytes[at] ^= bit;
  }
  free(bytes);
  return 0;
}

static int settings_change_what_they_name(void) {
  const char* const longer[] = {"needle.length_mm=133", "run.dt_ms=2"};
  const char* const typo[] = {"needle.lenth_mm=133"};
  const char* const null[] = {NULL};
  stylet_rt_model* model = NULL;
  stylet_rt_model_info info;
  char error[512];
  CHECK(stylet_rt_model_load(in_folder("box.stylet"), longer, 2, &model, error, sizeof error) == STYLET_RT_OK);
  CHECK(stylet_rt_model_read_info(model, &info) == STYLET_RT_OK);
  CHECK(info.needle_length_mm == 133.0);
  CHECK(info.dt_s == 1e-3 * 2.0);
  stylet_rt_model_destroy(model);
  CHECK(stylet_rt_model_load(in_folder("box.stylet"), typo, 1, &model, error, sizeof error) == STYLET_RT_INPUT_ERROR);
  CHECK(model == NULL);
  CHECK(strstr(error, "length_mm") != NULL);
  CHECK(stylet_rt_model_load(in_folder("box.stylet"), null, 1, &model, error, 512) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_load(in_folder("box.stylet"), NULL, 1, &model, error, 512) == STYLET_RT_BAD_ARGUMENT);
  return 0;
}

static int bad_settings_are_refused_with_the_words_of_a_file(void) {
  const char* const bad[][2] = {
      {"coupling.method=\"nearfield\"", "not an allowed word (did you mean \"near-field\"?)"},
      {"coupling.spacing_mm=-4", "coupling.spacing_mm = -4 is outside its range"},
      {"run.dt_ms=-1", "run.dt_ms = -1 is outside its range"},
      {"run.dt_ms=nan", "run.dt_ms = nan is not finite"},
      {"insertion[0].speed_mm_per_s=0", "insertion[0].speed_mm_per_s = 0 is outside its range"},
      {"insertion[0].speed_mm_per_s=inf", "insertion[0].speed_mm_per_s = inf is not finite"},
      {"needle.length_mm=1e9", "needle.length_mm = 1000000000 is outside its range"},
      {"needle.model=\"rod\"", "needle.model = \"rod\" is not an allowed word"},
      {"coupling.contacts=40.5", "coupling.contacts = 40.5 is not a whole number"},
      {"tissue.prostate.poisson=0.5", "tissue.prostate.poisson = 0.5 is outside its range"},
      {"coupling.contacts=0", "coupling.contacts = 0 is outside its range"}};
  for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
    stylet_rt_model* model = NULL;
    char error[512];
    CHECK(stylet_rt_model_load(in_folder("box.stylet"), &bad[k][0], 1, &model, error, sizeof error) ==
          STYLET_RT_INPUT_ERROR);
    CHECK(model == NULL);
    if (strstr(error, bad[k][1]) == NULL) fprintf(stderr, "%s: %s\n", bad[k][0], error);
    CHECK(strstr(error, bad[k][1]) != NULL);
  }
  return 0;
}

static int arguments_that_make_no_sense_are_statuses(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_model* no_model = NULL;
  stylet_rt_sim* sim = created(model, 0);
  stylet_rt_sim* none = sim;
  stylet_rt_model_info info;
  stylet_rt_insertion plan;
  stylet_rt_options options;
  stylet_rt_pose pose;
  stylet_rt_result result;
  stylet_rt_contact contact;
  stylet_rt_event event;
  stylet_rt_capacity capacity;
  double points[6];
  size_t count = 0;
  char error[512];

  CHECK(stylet_rt_abi_version() == STYLET_RT_ABI_VERSION);
  CHECK(strlen(stylet_rt_version()) >= 5);
  CHECK(strcmp(stylet_rt_status_text(-5), "unknown status") == 0);

  CHECK(stylet_rt_model_load(NULL, NULL, 0, &no_model, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(strstr(error, "path") != NULL);
  CHECK(stylet_rt_model_load(in_folder("box.stylet"), NULL, 0, NULL, NULL, 0) == STYLET_RT_BAD_ARGUMENT);
  stylet_rt_model_destroy(NULL);
  CHECK(stylet_rt_model_read_info(NULL, &info) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_read_info(model, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_read_info(model, &info) == STYLET_RT_OK);
  CHECK(info.insertions == 3 && info.regions == 3 && info.nodes == 343);
  CHECK(stylet_rt_model_region(NULL, 0) == NULL);
  CHECK(stylet_rt_model_region(model, -1) == NULL);
  CHECK(stylet_rt_model_region(model, 3) == NULL);
  CHECK(strcmp(stylet_rt_model_region(model, 1), "prostate") == 0);
  CHECK(stylet_rt_model_insertion(NULL, 0, &plan) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_insertion(model, 0, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_insertion(model, -1, &plan) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_insertion(model, 3, &plan) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_model_insertion_name(model, 3) == NULL);
  CHECK(strlen(stylet_rt_model_insertion_name(model, 1)) > 0);

  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  CHECK(stylet_rt_sim_create(NULL, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(none == NULL);
  CHECK(stylet_rt_sim_create(model, &options, NULL, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  options.insertion = 3;
  CHECK(stylet_rt_sim_create(model, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(strstr(error, "insertion") != NULL);
  options.insertion = -1;
  CHECK(stylet_rt_sim_create(model, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  options.insertion = 0;
  options.flags = UINT32_C(1) << 31;
  CHECK(stylet_rt_sim_create(model, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  options.flags = 0;
  options.struct_size = 0;
  CHECK(stylet_rt_sim_create(model, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(strstr(error, "struct_size") != NULL);
  options.struct_size = sizeof options + 8;
  CHECK(stylet_rt_sim_create(model, &options, &none, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_create(model, NULL, &none, error, sizeof error) == STYLET_RT_OK);
  stylet_rt_sim_destroy(none);
  stylet_rt_sim_destroy(NULL);

  CHECK(stylet_rt_sim_place(NULL, 0) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_place(sim, 3) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_planned_base(NULL, 0.0, &pose) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_planned_base(sim, 0.0, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_planned_base(sim, NAN, &pose) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_planned_base(sim, -1.0, &pose) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_step(NULL, &pose, 1e-3, &result) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_step(sim, NULL, 1e-3, &result) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_step(sim, &pose, 1e-3, NULL) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_read_result(NULL, &result) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_result(sim, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_prepare(NULL, error, sizeof error) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_prepare(sim, error, sizeof error) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_read_contacts(NULL, &contact, 1, &count) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_contacts(sim, NULL, 1, &count) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_contacts(sim, &contact, 1, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_contacts(sim, NULL, 0, &count) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_read_needle(NULL, points, 2) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_needle(sim, NULL, 2) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_needle(sim, points, 1) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_events(NULL, &event, 1, &count) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_events(sim, NULL, 1, &count) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_events(sim, &event, 1, NULL) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_capacity(NULL, STYLET_RT_CAPACITY_EVENTS, &capacity) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_capacity(sim, -1, &capacity) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_capacity(sim, 4, &capacity) == STYLET_RT_BAD_ARGUMENT);
  CHECK(stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_EVENTS, NULL) == STYLET_RT_BAD_ARGUMENT);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return 0;
}

static int a_pose_that_is_none_leaves_everything_as_it_was(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = created(model, 0);
  stylet_rt_sim* same = created(model, 0);
  const double dt = time_step(model);
  const double bad_numbers[] = {NAN, INFINITY, -INFINITY};
  int k;
  size_t b;
  for (k = 1; k < 250; ++k) {
    stylet_rt_result a, b_result;
    const stylet_rt_result before = stepped(sim, k, dt);
    stylet_rt_pose pose, bad;
    CHECK(stylet_rt_sim_planned_base(sim, k * dt, &pose) == STYLET_RT_OK);
    for (b = 0; b < 3; ++b) {
      bad = pose;
      bad.position_mm[k % 3] = bad_numbers[b];
      CHECK(stylet_rt_sim_step(sim, &bad, dt, &a) == STYLET_RT_BAD_ARGUMENT);
      bad = pose;
      bad.rotation[k % 4] = bad_numbers[b];
      CHECK(stylet_rt_sim_step(sim, &bad, dt, &a) == STYLET_RT_BAD_ARGUMENT);
      CHECK(stylet_rt_sim_step(sim, &pose, bad_numbers[b], &a) == STYLET_RT_BAD_ARGUMENT);
    }
    memset(bad.rotation, 0, sizeof bad.rotation);
    bad.rotation[0] = 1.01;
    CHECK(stylet_rt_sim_step(sim, &bad, dt, &a) == STYLET_RT_BAD_ARGUMENT);
    CHECK(stylet_rt_sim_step(sim, &pose, 0.0, &a) == STYLET_RT_BAD_ARGUMENT);
    CHECK(stylet_rt_sim_step(sim, &pose, -dt, &a) == STYLET_RT_BAD_ARGUMENT);
    CHECK(stylet_rt_sim_step(sim, &pose, 1.1, &a) == STYLET_RT_BAD_ARGUMENT);
    CHECK((a.flags & STYLET_RT_INVALID_INPUT) != 0 && (a.flags & STYLET_RT_DISTRUSTED) != 0);
    CHECK(a.events == 0 && a.time_s == before.time_s && a.force_axial_N == before.force_axial_N);
    CHECK(memcmp(a.tip_mm, before.tip_mm, sizeof a.tip_mm) == 0);
    b_result = stepped(same, k, dt);
    CHECK(memcmp(&before, &b_result, sizeof before) == 0);
  }
  /* A rotation with single precision is accurate enough. */
  {
    stylet_rt_pose pose;
    stylet_rt_result a, exact;
    int i;
    CHECK(stylet_rt_sim_planned_base(sim, k * dt, &pose) == STYLET_RT_OK);
    CHECK(stylet_rt_sim_step(same, &pose, dt, &exact) == STYLET_RT_OK);
    for (i = 0; i < 4; ++i) pose.rotation[i] *= 1.0 + 1e-4;
    CHECK(stylet_rt_sim_step(sim, &pose, dt, &a) == STYLET_RT_OK);
    CHECK(fabs(a.tip_mm[2] - exact.tip_mm[2]) < 1e-6);
    CHECK(fabs(a.force_axial_N - exact.force_axial_N) < 1e-6);
  }
  stylet_rt_sim_destroy(sim);
  stylet_rt_sim_destroy(same);
  stylet_rt_model_destroy(model);
  return 0;
}

static int what_there_is_no_room_for_is_left_out(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = created(model, 0);
  stylet_rt_contact contacts[4], all[MOST_CONTACTS];
  stylet_rt_event events[2];
  stylet_rt_result result;
  stylet_rt_capacity capacity;
  double points[9];
  size_t count = 0, k;
  int step, events_seen = 0;
  memset(contacts, 0, sizeof contacts);
  memset(events, 0, sizeof events);
  for (step = 1; step < 300; ++step) {
    result = stepped(sim, step, time_step(model));
    if (result.events == 0) continue;
    events[0].kind = -1;
    CHECK(stylet_rt_sim_read_events(sim, events, 0, &count) == STYLET_RT_OK);
    CHECK(count == (size_t)result.events && events[0].kind == -1);
    CHECK(stylet_rt_sim_read_events(sim, events, 1, &count) == STYLET_RT_OK);
    CHECK(events[0].kind >= 0 && events[1].kind == 0 && events[1].time_s == 0.0);
    ++events_seen;
  }
  CHECK(events_seen > 1);
  CHECK(result.contacts > 4);
  CHECK(stylet_rt_sim_read_contacts(sim, contacts, 3, &count) == STYLET_RT_OK);
  CHECK(count == (size_t)result.contacts);
  CHECK(contacts[2].length_mm > 0.0 && contacts[3].length_mm == 0.0);
  CHECK(stylet_rt_sim_read_contacts(sim, all, MOST_CONTACTS, &count) == STYLET_RT_OK);
  for (k = 0; k < 3; ++k) CHECK(memcmp(&contacts[k], &all[k], sizeof all[k]) == 0);
  CHECK(stylet_rt_sim_read_needle(sim, points, 3) == STYLET_RT_OK);
  CHECK(memcmp(points, result.base_mm, sizeof result.base_mm) == 0);
  CHECK(memcmp(points + 6, result.tip_mm, sizeof result.tip_mm) == 0);
  CHECK(stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_CONTACTS, &capacity) == STYLET_RT_OK);
  CHECK(capacity.most >= result.contacts - 1 && capacity.most < capacity.room);
  CHECK(stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_SPARE_NODES, &capacity) == STYLET_RT_OK);
  CHECK(capacity.most >= 0 && capacity.room == 1500); /* coupling.spare_nodes */
  CHECK(stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_EVENTS, &capacity) == STYLET_RT_OK);
  CHECK(capacity.most >= 1 && capacity.most < capacity.room);
  CHECK(stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_TRACKS, &capacity) == STYLET_RT_OK);
  CHECK(capacity.most == 0 && capacity.room == 64);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return 0;
}

/* Makes all real-time calls during a complete insertion. @return the largest force */
static double all_real_time_calls(const stylet_rt_model* model, stylet_rt_sim* sim, double duration_s) {
  static stylet_rt_contact contacts[MOST_CONTACTS];
  static stylet_rt_event events[STYLET_RT_MAX_EVENTS];
  static double points[3 * POINTS];
  stylet_rt_model_info info;
  stylet_rt_pose base;
  stylet_rt_result result;
  stylet_rt_capacity capacity;
  double most_N = 0.0;
  size_t count;
  int k;
  stylet_rt_model_read_info(model, &info);
  for (k = 1; k * info.dt_s < duration_s; ++k) {
    stylet_rt_sim_planned_base(sim, k * info.dt_s, &base);
    stylet_rt_sim_step(sim, &base, info.dt_s, NULL);
    stylet_rt_sim_read_result(sim, &result);
    stylet_rt_sim_read_contacts(sim, contacts, MOST_CONTACTS, &count);
    stylet_rt_sim_read_events(sim, events, STYLET_RT_MAX_EVENTS, &count);
    stylet_rt_sim_read_needle(sim, points, POINTS);
    stylet_rt_sim_read_capacity(sim, STYLET_RT_CAPACITY_SPARE_NODES, &capacity);
    if (result.force_axial_N > most_N) most_N = result.force_axial_N;
    if (result.flags != 0) return -1.0;
    base.position_mm[0] = NAN;
    stylet_rt_sim_step(sim, &base, info.dt_s, &result);
  }
  return most_N;
}

static int a_step_does_not_allocate(void) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = created(model, 0);
  const double duration_s = duration(model, 0);
  const long before = allocations_so_far();
  double most_N;
  void* volatile block = NULL; /* volatile, so that the compiler does not remove the allocation */
  if (before < 0) return SKIPPED;
  most_N = all_real_time_calls(model, sim, duration_s);
  CHECK(allocations_so_far() == before);
  CHECK(most_N > 0.3);
  block = malloc(1);
  CHECK(allocations_so_far() == before + 1); /* the counter works */
  free(block);
  CHECK(allocations_so_far() == before + 2);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return 0;
}

/* Runs steps in a process that the kernel kills at any system call except exit. */
static int a_step_does_not_call_the_system(void) {
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = created(model, 0);
  const double duration_s = duration(model, 0);
  int calls;
  for (calls = 0; calls < 2; ++calls) {
    int status = 0;
    const pid_t child = fork();
    if (child == 0) {
      double most_N;
      if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(SKIPPED);
      most_N = all_real_time_calls(model, sim, duration_s);
      if (calls == 1) getppid(); /* checks that a process with a system call is killed */
      syscall(SYS_exit, most_N > 0.3 ? 0 : 1);
    }
    CHECK(child > 0 && waitpid(child, &status, 0) == child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == SKIPPED) return SKIPPED;
    CHECK(calls == 1 ? WIFSIGNALED(status) : WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return 0;
#else
  return SKIPPED;
#endif
}

typedef struct {
  const stylet_rt_model* model;
  stylet_rt_sim* sim;
  double duration_s;
  double most_N;
} whole_insertion;

static void* insert(void* argument) {
  whole_insertion* it = argument;
  it->most_N = all_real_time_calls(it->model, it->sim, it->duration_s);
  return NULL;
}

/* The thread would crash with too small a stack. */
static int a_quarter_of_a_megabyte_of_stack_is_enough(void) {
  whole_insertion it = {NULL, NULL, 0.0, 0.0};
  stylet_rt_model* model = loaded();
  pthread_attr_t attributes;
  pthread_t thread;
  it.model = model;
  it.sim = created(model, 0);
  it.duration_s = duration(model, 0);
  CHECK(pthread_attr_init(&attributes) == 0);
  CHECK(pthread_attr_setstacksize(&attributes, 256 * 1024) == 0);
  CHECK(pthread_create(&thread, &attributes, insert, &it) == 0);
  CHECK(pthread_join(thread, NULL) == 0);
  CHECK(it.most_N > 0.3);
  pthread_attr_destroy(&attributes);
  stylet_rt_sim_destroy(it.sim);
  stylet_rt_model_destroy(model);
  return 0;
}

/* Creates a simulation with these flags and steps to a base pose for which the tip is in the air at a denormal x.
 * @return x of the tip after the step */
static double denormal_x_of_the_tip(uint32_t flags) {
  stylet_rt_model* model = loaded();
  stylet_rt_sim* sim = NULL;
  stylet_rt_options options;
  stylet_rt_pose base;
  stylet_rt_result result;
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.flags = flags;
  memset(&base, 0, sizeof base);
  base.position_mm[0] = DBL_MIN / 4;
  base.position_mm[2] = -1000.0;
  base.rotation[0] = 1.0;
  CHECK(stylet_rt_sim_create(model, &options, &sim, NULL, 0) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_step(sim, &base, 1e-3, NULL) == STYLET_RT_OK);
  CHECK(stylet_rt_sim_read_result(sim, &result) == STYLET_RT_OK);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return result.tip_mm[0];
}

static int denormal_numbers_are_zero_in_a_step_and_back_after_it(void) {
  const volatile double smallest = DBL_MIN;
  double x;
  if (!FLUSHES) return SKIPPED;
  CHECK(smallest / 2 > 0.0);
  x = denormal_x_of_the_tip(0);
  CHECK(smallest / 2 > 0.0);
  CHECK(x == 0.0);
  return 0;
}

static int a_step_that_keeps_denormal_numbers_leaves_the_mode_alone(void) {
  double x = denormal_x_of_the_tip(STYLET_RT_KEEP_DENORMALS);
  CHECK(x == DBL_MIN / 4);
#ifdef __SSE2__
  {
    const unsigned usual = _mm_getcsr();
    _mm_setcsr(usual | FTZ_DAZ);
    x = denormal_x_of_the_tip(STYLET_RT_KEEP_DENORMALS);
    CHECK((_mm_getcsr() & FTZ_DAZ) == FTZ_DAZ);
    _mm_setcsr(usual);
    CHECK(x == 0.0);
  }
#endif
  return 0;
}

#define CLAIM(name) \
  { #name, name }
static const struct {
  const char* name;
  int (*test)(void);
} claims[] = {CLAIM(its_numbers_are_those_of_the_interface_in_cpp_to_the_last_bit),
              CLAIM(two_simulations_share_a_model),
              CLAIM(files_that_are_no_model_are_refused_with_place_and_cure),
              CLAIM(a_file_with_any_bit_changed_is_refused),
              CLAIM(settings_change_what_they_name),
              CLAIM(bad_settings_are_refused_with_the_words_of_a_file),
              CLAIM(arguments_that_make_no_sense_are_statuses),
              CLAIM(a_pose_that_is_none_leaves_everything_as_it_was),
              CLAIM(what_there_is_no_room_for_is_left_out),
              CLAIM(a_step_does_not_allocate),
              CLAIM(a_step_does_not_call_the_system),
              CLAIM(a_quarter_of_a_megabyte_of_stack_is_enough),
              CLAIM(denormal_numbers_are_zero_in_a_step_and_back_after_it),
              CLAIM(a_step_that_keeps_denormal_numbers_leaves_the_mode_alone)};

int main(int argc, char** argv) {
  size_t k;
  if (argc != 3) {
    fprintf(stderr, "usage: test_stylet_rt CLAIM FOLDER\n");
    return 2;
  }
  folder = argv[2];
  for (k = 0; k < sizeof claims / sizeof claims[0]; ++k) {
    if (strcmp(argv[1], claims[k].name) == 0) {
      const int status = claims[k].test();
      return failures > 0 ? 1 : status;
    }
  }
  fprintf(stderr, "no such claim: %s\n", argv[1]);
  return 2;
}
