/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Puts needles into a patient, one beside the other, from C, and writes the displaced surfaces.
 *
 *   stylet prepare SCENARIO.toml -o MODEL.stylet
 *   stylet-three-needles MODEL.stylet PICTURE.obj
 *
 * The scenario has an [[insertion]] for each needle; the first three are used. Each needle goes to its planned depth
 * and stays there, its hub locked, while the next one goes in. Prints how the needles that stay feel the one that
 * moves, and how far the surfaces have been moved. PICTURE.obj (Wavefront) has the displaced surfaces, a group for each
 * pair of regions, and the needles as lines. To build it outside of Stylet's sources:
 *
 *   cc -O2 three_needles.c $(pkg-config --cflags --libs stylet_rt) -lm
 *
 * Not a medical device. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stylet/stylet_rt.h>

enum { NEEDLES = 3, POINTS = 41 };
static const double DT_S = 2e-3;

static int failed(const char* error) {
  fprintf(stderr, "%s\n", error);
  return 1;
}

/* Moves the held needle by its plan until it is at its depth. @return number of flagged steps, or -1 */
static long put_in(stylet_rt_sim* sim, double depth_mm, double duration_s) {
  stylet_rt_result result;
  stylet_rt_pose base;
  long flagged = 0, k;
  for (k = 1; (double)k * DT_S < duration_s; ++k) {
    /* A program with a haptic device or a robot would take the pose of its handle here. */
    if (stylet_rt_sim_planned_base(sim, (double)k * DT_S, &base) != STYLET_RT_OK) return -1;
    if (stylet_rt_sim_step(sim, &base, DT_S, &result) != STYLET_RT_OK) return -1;
    flagged += result.flags != 0;
    if (result.base_depth_mm > depth_mm - 1e-6) break;
  }
  return flagged;
}

static double length(const double* v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static const char* name_of(const stylet_rt_model* model, int32_t region) {
  const char* name = stylet_rt_model_region(model, region);
  return name != NULL ? name : "outside";
}

/* Writes triangles between the same two regions as one group, and a line for each needle. */
static int write_obj(const char* path, const stylet_rt_model* model, const stylet_rt_sim* sim, int needles,
                     const stylet_rt_triangle* triangles, size_t count, const double* points_mm, size_t points) {
  double line[3 * POINTS];
  size_t k;
  int n;
  const stylet_rt_triangle* last = NULL;
  FILE* file = fopen(path, "w");
  if (file == NULL) return 0;
  for (k = 0; k < points; ++k)
    fprintf(file, "v %.4f %.4f %.4f\n", points_mm[3 * k], points_mm[3 * k + 1], points_mm[3 * k + 2]);
  for (k = 0; k < count; ++k) {
    const stylet_rt_triangle* t = &triangles[k];
    if (last == NULL || t->inside != last->inside || t->outside != last->outside)
      fprintf(file, "g %s-%s\n", name_of(model, t->inside), name_of(model, t->outside));
    fprintf(file, "f %d %d %d\n", (int)t->corner[0] + 1, (int)t->corner[1] + 1, (int)t->corner[2] + 1);
    last = t;
  }
  for (n = 0; n < needles; ++n) {
    if (stylet_rt_sim_read_needle_of(sim, n, line, POINTS) != STYLET_RT_OK) break;
    fprintf(file, "g needle_%d\n", n + 1);
    for (k = 0; k < POINTS; ++k) fprintf(file, "v %.4f %.4f %.4f\n", line[3 * k], line[3 * k + 1], line[3 * k + 2]);
    fprintf(file, "l");
    for (k = 0; k < POINTS; ++k) fprintf(file, " %zu", points + (size_t)n * POINTS + k + 1);
    fprintf(file, "\n");
  }
  return fclose(file) == 0;
}

/* Puts the needles in and draws them. @return exit status */
static int run(const stylet_rt_model* model, stylet_rt_sim* sim, stylet_rt_display* display, int needles,
               const char* path) {
  char error[512];
  double hub_N[3], before_N[NEEDLES], left_out_N = 0.0, most = 0.0, *points_mm, *rest_mm;
  stylet_rt_triangle* triangles;
  size_t count = 0, points = 0, k;
  int n, other, status = 0;
  stylet_rt_display_read_triangles(display, NULL, 0, &count, &points);
  triangles = malloc(count * sizeof *triangles);
  points_mm = malloc(3 * points * sizeof *points_mm);
  rest_mm = malloc(3 * points * sizeof *rest_mm);
  if (triangles == NULL || points_mm == NULL || rest_mm == NULL) {
    status = failed("no memory for the surfaces");
    needles = 0;
  } else {
    stylet_rt_display_read_triangles(display, triangles, count, &count, NULL);
    stylet_rt_display_read_points(display, rest_mm, points, NULL);
  }
  for (n = 0; n < needles && status == 0; ++n) {
    stylet_rt_insertion plan;
    long flagged;
    for (other = 0; other < n; ++other) {
      stylet_rt_sim_hub_force(sim, other, hub_N);
      before_N[other] = length(hub_N);
    }
    if (stylet_rt_sim_take_up(sim, n, n, error, sizeof error) != STYLET_RT_OK) {
      status = failed(error);
      break;
    }
    stylet_rt_model_insertion(model, n, &plan);
    flagged = put_in(sim, plan.depth_mm, plan.duration_s);
    if (flagged < 0) {
      status = failed("a step was refused");
      break;
    }
    stylet_rt_sim_hub_force(sim, n, hub_N);
    printf("needle %d (%s): %.2f N on the hand at %.1f mm, %ld steps flagged\n", n + 1,
           stylet_rt_model_insertion_name(model, n), length(hub_N), plan.depth_mm, flagged);
    for (other = 0; other < n; ++other) {
      stylet_rt_sim_hub_force(sim, other, hub_N);
      printf("  the hub of needle %d holds %.2f N, %.2f N before\n", other + 1, length(hub_N), before_N[other]);
    }
  }
  if (status == 0) {
    stylet_rt_display_take(display, sim);
    stylet_rt_display_read_points(display, points_mm, points, &left_out_N);
    for (k = 0; k < 3 * points; k += 3) {
      const double way[3] = {points_mm[k] - rest_mm[k], points_mm[k + 1] - rest_mm[k + 1],
                             points_mm[k + 2] - rest_mm[k + 2]};
      most = fmax(most, length(way));
    }
    printf("%zu triangles; their points have moved by up to %.2f mm; %.2f N are not shown\n", count, most, left_out_N);
    if (!write_obj(path, model, sim, needles, triangles, count, points_mm, points)) {
      fprintf(stderr, "%s: cannot be written\n", path);
      status = 1;
    }
  }
  free(rest_mm);
  free(points_mm);
  free(triangles);
  return status;
}

int main(int argc, char** argv) {
  stylet_rt_model* model = NULL;
  stylet_rt_sim* sim = NULL;
  stylet_rt_display* display = NULL;
  stylet_rt_options options;
  stylet_rt_model_info info;
  char error[1024];
  int status;
  if (argc != 3) {
    fprintf(stderr, "usage: %s MODEL.stylet PICTURE.obj\n", argv[0]);
    return 2;
  }
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.needles = NEEDLES;
  if (stylet_rt_model_load(argv[1], NULL, 0, &model, error, sizeof error) != STYLET_RT_OK ||
      stylet_rt_sim_create(model, &options, &sim, error, sizeof error) != STYLET_RT_OK ||
      stylet_rt_display_create(model, &display, error, sizeof error) != STYLET_RT_OK) {
    status = failed(error);
  } else {
    stylet_rt_model_read_info(model, &info);
    if (info.insertions < NEEDLES) printf("%s has %d insertions, not %d\n", argv[1], (int)info.insertions, NEEDLES);
    status = run(model, sim, display, info.insertions < NEEDLES ? (int)info.insertions : NEEDLES, argv[2]);
  }
  stylet_rt_display_destroy(display);
  stylet_rt_sim_destroy(sim);
  stylet_rt_model_destroy(model);
  return status;
}
