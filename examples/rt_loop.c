/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulates a needle in a patient from C, in a loop at 1 kHz.
 *
 *   stylet prepare SCENARIO.toml -o MODEL.stylet
 *   stylet-rt-loop MODEL.stylet [--insertion N] [--no-clock] [--no-rights]
 *
 * Prints the time from the start of the program to the first step, then follows the planned insertion and prints the
 * forces of the hand and the computing times of the steps. --no-clock takes the steps without waiting for the clock;
 * --no-rights does not request real-time scheduling and locked memory. To build it outside of Stylet's sources:
 *
 *   cc -O2 rt_loop.c $(pkg-config --cflags --libs stylet_rt) -lpthread */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stylet/stylet_rt.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>

enum { PERIOD_NS = 1000000, STACK_BYTES = 512 * 1024, PRIORITY = 80, LINES_PER_S = 4 };

static double now_s(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int smaller_first(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static const char* tip_state(int32_t state) {
  static const char* const names[] = {"air", "pressing", "cutting", "in track", "bone", "exited"};
  return state >= 0 && state < 6 ? names[state] : "?";
}

static const char* event_kind(int32_t kind) {
  static const char* const names[] = {"skin contact", "puncture",  "region entered", "retraction start",
                                      "slip start",   "withdrawn", "bone contact",   "exited",
                                      "re-entered",   "grazed"};
  return kind >= 0 && kind < 10 ? names[kind] : "?";
}

/* The loop's thread stores its results in rows; they are printed after the loop. */
typedef struct {
  double step_us; /* processor time */
  stylet_rt_result result;
  stylet_rt_event event;
  int32_t events;
} row;

typedef struct {
  stylet_rt_sim* sim;
  const char* rights;
  int keep_to_clock, ask_for_rights;
  row* rows;
  size_t steps;
  size_t late; /* number of steps that began more than a period after they were due */
  long page_faults;
  stylet_rt_status status;
} loop;

/* Requests real-time scheduling for this thread, and locks all memory of the process. */
static const char* ask_for_rights(void) {
  struct sched_param param;
  memset(&param, 0, sizeof param);
  param.sched_priority = PRIORITY;
  const int scheduled = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
  const int locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  if (scheduled && locked) return "real-time scheduling, memory locked";
  if (scheduled) return "real-time scheduling, memory not locked (not permitted)";
  if (locked) return "ordinary scheduling (real-time not permitted), memory locked";
  return "ordinary scheduling, memory not locked (neither permitted)";
}

/* Touches the stack, so that its pages are mapped before the loop. */
static void touch_stack(void) {
  volatile char stack[STACK_BYTES];
  size_t k;
  for (k = 0; k < sizeof stack; k += 4096) stack[k] = 0;
}

static long page_faults(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

static void* run(void* argument) {
  loop* l = argument;
  struct timespec due;
  size_t k;
  touch_stack();
  l->rights = l->ask_for_rights ? ask_for_rights() : "ordinary scheduling, memory not locked";
  const long faults = page_faults();
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (k = 0; k < l->steps; ++k) {
    row* r = &l->rows[k];
    stylet_rt_pose base;
    size_t events = 0;
    if (l->keep_to_clock) {
      due.tv_nsec += PERIOD_NS;
      if (due.tv_nsec >= 1000000000) {
        due.tv_nsec -= 1000000000;
        ++due.tv_sec;
      }
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL) == EINTR) continue;
      const double delay = now_s(CLOCK_MONOTONIC) - ((double)due.tv_sec + 1e-9 * (double)due.tv_nsec);
      if (delay > 1e-9 * PERIOD_NS) ++l->late;
    }

    /* A program with a haptic device would read the handle's pose here. */
    stylet_rt_sim_planned_base(l->sim, 1e-9 * PERIOD_NS * (double)(k + 1), &base);

    const double before = now_s(CLOCK_THREAD_CPUTIME_ID);
    l->status = stylet_rt_sim_step(l->sim, &base, 1e-9 * PERIOD_NS, &r->result);
    r->step_us = 1e6 * (now_s(CLOCK_THREAD_CPUTIME_ID) - before);
    if (l->status != STYLET_RT_OK) {
      l->steps = k;
      break;
    }

    /* It would send -hand_force_N to the device here, unless (flags & STYLET_RT_DISTRUSTED). */
    stylet_rt_sim_read_events(l->sim, &r->event, 1, &events);
    r->events = (int32_t)events;
  }
  l->page_faults = page_faults() - faults;
  return NULL;
}

static void print_forces(const loop* l, const stylet_rt_model* model) {
  const size_t every = 1000 / LINES_PER_S;
  size_t k;
  printf(
      "\n  time [s]  depth [mm]  axial [N]  lateral  sagittal     tip LPS [mm]          tip state  contacts  flags\n");
  for (k = 0; k < l->steps; ++k) {
    const row* w = &l->rows[k];
    const stylet_rt_result* r = &w->result;
    if (w->events > 0) {
      const char* region = stylet_rt_model_region(model, w->event.region);
      printf("  %8.3f  %10.2f  %9.3f  -- %s%s%s\n", w->event.time_s, w->event.depth_mm, w->event.force_N,
             event_kind(w->event.kind), region != NULL ? ", " : "", region != NULL ? region : "");
    }
    if ((k + 1) % every != 0) continue;
    printf("  %8.3f  %10.2f  %9.3f  %7.3f  %8.3f  %7.2f %7.2f %7.2f  %9s  %8d  0x%02x\n", r->time_s, r->base_depth_mm,
           r->force_axial_N, r->force_lateral_N, r->force_sagittal_N, r->tip_mm[0], r->tip_mm[1], r->tip_mm[2],
           tip_state(r->tip_state), (int)r->contacts, (unsigned)r->flags);
  }
}

static void print_times(const loop* l) {
  double* us = malloc(l->steps * sizeof *us);
  size_t k, flagged = 0;
  uint32_t flags = 0;
  if (us == NULL || l->steps == 0) {
    free(us);
    return;
  }
  for (k = 0; k < l->steps; ++k) {
    us[k] = l->rows[k].step_us;
    flags |= l->rows[k].result.flags;
    flagged += l->rows[k].result.flags != 0;
  }
  qsort(us, l->steps, sizeof *us, smaller_first);
  printf("\nsteps               %zu, %zu of them flagged (0x%02x), %zu begun late\n", l->steps, flagged,
         (unsigned)flags, l->late);
  printf("processor time [us] p50 %.0f, p99 %.0f, longest %.0f\n", us[l->steps / 2], us[l->steps * 99 / 100],
         us[l->steps - 1]);
  printf("page faults         %ld\n", l->page_faults);
  free(us);
}

/* Does everything that takes memory or time, before the loop. @return exit status */
static int prepare(const char* path, int32_t insertion, stylet_rt_model** model, stylet_rt_sim** sim) {
  char error[1024];
  stylet_rt_model_info info;
  stylet_rt_options options;
  stylet_rt_pose base;
  stylet_rt_result result;
  const double start = now_s(CLOCK_MONOTONIC);
  stylet_rt_status status = stylet_rt_model_load(path, NULL, 0, model, error, sizeof error);
  const double loaded = now_s(CLOCK_MONOTONIC);
  if (status == STYLET_RT_OK) {
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.insertion = insertion;
    status = stylet_rt_sim_create(*model, &options, sim, error, sizeof error);
  }
  const double created = now_s(CLOCK_MONOTONIC);
  if (status != STYLET_RT_OK) {
    fprintf(stderr, "%s\n", error);
    return status == STYLET_RT_INPUT_ERROR || status == STYLET_RT_BAD_ARGUMENT ? 2 : 1;
  }
  stylet_rt_sim_planned_base(*sim, 1e-9 * PERIOD_NS, &base);
  stylet_rt_sim_step(*sim, &base, 1e-9 * PERIOD_NS, &result);
  const double stepped = now_s(CLOCK_MONOTONIC);
  stylet_rt_sim_place(*sim, insertion);
  const double placed = now_s(CLOCK_MONOTONIC);
  stylet_rt_model_read_info(*model, &info);
  printf("%s: %d nodes, %d tetrahedra, insertion %s\n", path, (int)info.nodes, (int)info.tets,
         stylet_rt_model_insertion_name(*model, insertion));
  printf("load the model      %9.3f s\n", loaded - start);
  printf("create, and place   %9.3f ms\n", 1e3 * (created - loaded));
  printf("first step          %9.3f ms\n", 1e3 * (stepped - created));
  printf("place again         %9.3f ms\n", 1e3 * (placed - stepped));
  printf("to the first step   %9.3f s\n", stepped - start);
  return 0;
}

int main(int argc, char** argv) {
  stylet_rt_model* model = NULL;
  stylet_rt_insertion plan;
  loop l;
  pthread_t thread;
  long insertion = 0;
  const char* path = NULL;
  int k, wrong = 0, status = 0;
  memset(&l, 0, sizeof l);
  l.keep_to_clock = l.ask_for_rights = 1;
  for (k = 1; k < argc; ++k) {
    if (strcmp(argv[k], "--no-clock") == 0) {
      l.keep_to_clock = 0;
    } else if (strcmp(argv[k], "--no-rights") == 0) {
      l.ask_for_rights = 0;
    } else if (strcmp(argv[k], "--insertion") == 0 && k + 1 < argc) {
      insertion = strtol(argv[++k], NULL, 10);
    } else if (argv[k][0] != '-' && path == NULL) {
      path = argv[k];
    } else {
      wrong = 1;
    }
  }
  if (wrong || path == NULL || insertion < 0 || insertion > INT32_MAX) {
    fprintf(stderr, "usage: %s MODEL.stylet [--insertion N] [--no-clock] [--no-rights]\n", argv[0]);
    return 2;
  }
  if (stylet_rt_abi_version() != STYLET_RT_ABI_VERSION) {
    fprintf(stderr, "this program was built for version %d of libstylet_rt's interface, the library has version %u\n",
            STYLET_RT_ABI_VERSION, (unsigned)stylet_rt_abi_version());
    return 1;
  }

  status = prepare(path, (int32_t)insertion, &model, &l.sim);
  if (status == 0) {
    stylet_rt_model_insertion(model, (int32_t)insertion, &plan);
    l.steps = (size_t)(plan.duration_s / (1e-9 * PERIOD_NS)) + 1;
    l.rows = calloc(l.steps, sizeof *l.rows);
    if (l.rows != NULL) memset(l.rows, 0xff, l.steps * sizeof *l.rows); /* touches the pages, so that they are mapped */
    if (l.rows == NULL || pthread_create(&thread, NULL, run, &l) != 0) {
      fprintf(stderr, "no memory or no thread for the loop\n");
      status = 1;
    } else {
      pthread_join(thread, NULL);
      printf("loop                %s\n", l.rights);
      print_forces(&l, model);
      print_times(&l);
      if (l.status != STYLET_RT_OK) {
        fprintf(stderr, "a step returned: %s\n", stylet_rt_status_text(l.status));
        status = 1;
      }
    }
  }
  free(l.rows);
  stylet_rt_sim_destroy(l.sim);
  stylet_rt_model_destroy(model);
  return status;
}
