/* SPDX-License-Identifier: GPL-3.0-or-later */
/* C interface of Stylet: simulates a flexible needle in soft tissue, step by step, in the caller's own real-time loop.
 *
 *   load a saved model (stylet prepare)  ->  create a simulation  ->  step, step, step  ->  destroy both
 *
 * A model holds the data that take long to compute. It is constant, and simulations in several threads may share it. A
 * simulation is one patient with one needle or several, of which the hand moves one at a time; only one thread at a
 * time may use it. examples/rt_loop.c and examples/three_needles.c are complete programs.
 *
 * Units are mm, N, s, rad. Coordinates are the patient's, DICOM LPS: +x left, +y posterior, +z superior. The needle
 * leaves its base along the base's local z axis.
 *
 * Real time: functions marked [real time] do not allocate, lock, wait, call the operating system, log or throw, and
 * their time does not depend on the size of the mesh. All other functions are to be called before or after the loop, or
 * between steps without a deadline. docs/realtime.md explains how to run the loop on a hard real-time system.
 *
 * Errors: functions that can fail return a status; 0 = STYLET_RT_OK. Null and out-of-range arguments give a status as
 * well. No C++ exception leaves the library. A function with `error` and `error_size` writes a message there: the
 * place, what is wrong, and the cure, in one zero-terminated line that is cut to fit; on success the line is empty.
 * Both arguments may be 0. If a function fails, it leaves its output arguments unchanged, unless stated otherwise.
 *
 * Binary interface: numbers have fixed widths, and structures have no hidden padding. A change that breaks programs
 * increases STYLET_RT_ABI_VERSION and the number in the library's file name; new functions do not.
 *
 * Not a medical device. */
#ifndef STYLET_STYLET_RT_H
#define STYLET_STYLET_RT_H

/* NOLINTBEGIN(modernize-*): this is C */
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define STYLET_RT_API __attribute__((visibility("default")))
#else
#define STYLET_RT_API
#endif
#if defined(__cplusplus) && __cplusplus >= 201103L
#define STYLET_RT_NOEXCEPT noexcept
#else
#define STYLET_RT_NOEXCEPT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- versions ---------------------------------------------------------------------------------------------------- */

#define STYLET_RT_ABI_VERSION 1

/* The STYLET_RT_ABI_VERSION with which the library was built, to be compared with the header's. [real time] */
STYLET_RT_API uint32_t stylet_rt_abi_version(void) STYLET_RT_NOEXCEPT;

/* Version of Stylet, e.g. "0.2.0" or "0.2.0+1a2b3c4d" (with the commit). [real time] */
STYLET_RT_API const char* stylet_rt_version(void) STYLET_RT_NOEXCEPT;

/* ---- statuses ---------------------------------------------------------------------------------------------------- */

typedef int32_t stylet_rt_status;
enum {
  STYLET_RT_OK = 0,
  STYLET_RT_FAILED = 1,       /* the input may be right, but the operation failed */
  STYLET_RT_INPUT_ERROR = 2,  /* a file or a setting is wrong; the message names the place, the value and the cure */
  STYLET_RT_BAD_ARGUMENT = 3, /* null, out of range, not finite, or a structure of unknown size */
  STYLET_RT_OUT_OF_MEMORY = 4
};

/* A short text for a status. [real time] */
STYLET_RT_API const char* stylet_rt_status_text(stylet_rt_status status) STYLET_RT_NOEXCEPT;

/* ---- model ------------------------------------------------------------------------------------------------------- */

typedef struct stylet_rt_model stylet_rt_model;

/* Loads a saved model (`stylet prepare SCENARIO.toml -o MODEL.stylet`). A file in which any bit has changed is an
 * error. The scenario in the file and the settings are parsed by the program stylet-reader, which has ended when this
 * returns (docs/formats.md says where it is looked for).
 * @param settings keys of the scenario to change, "needle.length_mm=180", as for --set of `stylet insert`; changing a
 *        key on which the saved compliance depends is an error. May be null with settings_count = 0
 * @param model output: the model, or null on failure. To be released with stylet_rt_model_destroy */
STYLET_RT_API stylet_rt_status stylet_rt_model_load(const char* path, const char* const* settings,
                                                    size_t settings_count, stylet_rt_model** model, char* error,
                                                    size_t error_size) STYLET_RT_NOEXCEPT;

/* Releases a model. Simulations of it may continue; the memory is freed with the last of them. Null is allowed. */
STYLET_RT_API void stylet_rt_model_destroy(stylet_rt_model* model) STYLET_RT_NOEXCEPT;

/* Properties of a model. 64 bytes. */
typedef struct stylet_rt_model_info {
  double needle_length_mm;
  double needle_diameter_mm;
  double dt_s;          /* time step of the scenario (run.dt_ms); a loop may use another */
  double corridor_mm;   /* radius around the planned paths within which the compliance is precomputed */
  int32_t nodes;        /* number of nodes of the mesh */
  int32_t tets;         /* number of tetrahedra of the mesh */
  int32_t regions;      /* number of regions of the mesh, see stylet_rt_model_region */
  int32_t insertions;   /* number of planned insertions, see stylet_rt_model_insertion */
  int32_t max_contacts; /* largest number of contacts, tip included: sufficient room for stylet_rt_sim_read_contacts */
  int32_t reserved[3];  /* 0 */
} stylet_rt_model_info;

/* Reads the properties of a model. [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_model_read_info(const stylet_rt_model* model,
                                                         stylet_rt_model_info* info) STYLET_RT_NOEXCEPT;

/* Name of region 0 ... regions - 1, e.g. "prostate"; valid as long as the model. Null for other numbers. [real time] */
STYLET_RT_API const char* stylet_rt_model_region(const stylet_rt_model* model, int32_t region) STYLET_RT_NOEXCEPT;

/* A planned insertion. 64 bytes. */
typedef struct stylet_rt_insertion {
  double entry_mm[3];  /* LPS, skin point on the needle's line */
  double direction[3]; /* LPS, unit vector, into the patient */
  double depth_mm;     /* largest base depth: travel of the base after the tip of a straight needle is at the entry */
  double duration_s;   /* duration of the planned motion: in, pause and out, as in the scenario */
} stylet_rt_insertion;

/* Reads a planned insertion. [real time] @param index 0 ... insertions - 1 */
STYLET_RT_API stylet_rt_status stylet_rt_model_insertion(const stylet_rt_model* model, int32_t index,
                                                         stylet_rt_insertion* insertion) STYLET_RT_NOEXCEPT;

/* Name of a planned insertion: its template hole or "needle 1", ...; valid as long as the model. Null for an index out
 * of range. [real time] */
STYLET_RT_API const char* stylet_rt_model_insertion_name(const stylet_rt_model* model,
                                                         int32_t index) STYLET_RT_NOEXCEPT;

/* ---- simulation -------------------------------------------------------------------------------------------------- */

typedef struct stylet_rt_sim stylet_rt_sim;

/* Options for creating a simulation. Set struct_size and leave the other members 0 for the defaults; later versions may
 * add members at the end, whose default is 0. 16 bytes. */
typedef struct stylet_rt_options {
  uint32_t struct_size; /* sizeof(stylet_rt_options) */
  int32_t insertion;    /* planned insertion at whose start the needle is placed */
  uint32_t flags;       /* STYLET_RT_KEEP_DENORMALS, STYLET_RT_WORKER */
  uint32_t needles;     /* largest number of needles at the same time, up to STYLET_RT_MAX_NEEDLES; 0 = one */
} stylet_rt_options;

/* Largest number of needles in a simulation. Each takes memory for contacts of its own; the compliance among all of
 * them grows as the square of their number. */
#define STYLET_RT_MAX_NEEDLES 64

/* Steps do not change the processor's treatment of denormal numbers. Without this flag, a step makes the processor
 * treat them as zero and restores the former mode at its end (x86, 64-bit ARM), because with denormal numbers a step
 * can take many times as long. */
#define STYLET_RT_KEEP_DENORMALS UINT32_C(1)

/* The simulation has a thread of its own, with ordinary scheduling, that computes compliance ahead of the tip if the
 * needle leaves the prepared corridor. Steps remain real-time and use the compliance that is available. When the thread
 * is first needed it factorises the tissue, which takes as much time and memory as in `stylet prepare`. */
#define STYLET_RT_WORKER UINT32_C(2)

/* Creates a simulation with the needle at the start of a planned insertion, outside the patient. Allocates all memory
 * that its steps use.
 * @param options null for the defaults
 * @param sim output: the simulation, or null on failure. To be released with stylet_rt_sim_destroy */
STYLET_RT_API stylet_rt_status stylet_rt_sim_create(const stylet_rt_model* model, const stylet_rt_options* options,
                                                    stylet_rt_sim** sim, char* error,
                                                    size_t error_size) STYLET_RT_NOEXCEPT;

/* Releases a simulation. Null is allowed. With STYLET_RT_WORKER it waits for the thread's present unit of work, which
 * may be the factorisation. */
STYLET_RT_API void stylet_rt_sim_destroy(stylet_rt_sim* sim) STYLET_RT_NOEXCEPT;

/* Pose of the needle's base. 56 bytes. */
typedef struct stylet_rt_pose {
  double position_mm[3]; /* LPS */
  double rotation[4];    /* unit quaternion w, x, y, z: base to LPS; a length within 1e-3 of 1 is normalised */
} stylet_rt_pose;

/* Places the straight needle outside the patient at the start of a planned insertion. The tissue keeps the tracks that
 * have been cut; simulated time continues. @param insertion 0 ... insertions - 1 */
STYLET_RT_API stylet_rt_status stylet_rt_sim_place(stylet_rt_sim* sim, int32_t insertion) STYLET_RT_NOEXCEPT;

/* Lays the needle that the hand holds to rest and takes up another. A needle at rest keeps its hub where the hand left
 * it (locked, as by a template), holds the tissue, bends and slips, and takes part in every step. All other functions
 * that do not name a needle are about the one that the hand holds; the first one is needle 0. Allocates: call it
 * between steps without a deadline.
 * @param needle 0 ... needles - 1 of the options. Needles are taken up in the order of their numbers the first time
 * @param insertion planned insertion at whose start a needle that has not been in the hand before is placed; a needle
 *        that has been stays where it is, and may be moved on from there
 * On failure the hand holds the same needle as before. STYLET_RT_FAILED: there is no room for another contact; raise
 * coupling.contacts, or the model has an engine for one needle */
STYLET_RT_API stylet_rt_status stylet_rt_sim_take_up(stylet_rt_sim* sim, int32_t needle, int32_t insertion, char* error,
                                                     size_t error_size) STYLET_RT_NOEXCEPT;

/* Number of the needle that the hand holds; -1 for null. [real time] */
STYLET_RT_API int32_t stylet_rt_sim_held(const stylet_rt_sim* sim) STYLET_RT_NOEXCEPT;

/* Force of the hand, or of the lock at the hub, on the base of any needle that has been taken up. [real time]
 * @param force_N output (3) LPS */
STYLET_RT_API stylet_rt_status stylet_rt_sim_hub_force(const stylet_rt_sim* sim, int32_t needle,
                                                       double* force_N) STYLET_RT_NOEXCEPT;

/* The planned pose of the base at `time_s` after the start of the insertion at which the needle was last placed; the
 * base is at rest before the start and after the end. [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_sim_planned_base(const stylet_rt_sim* sim, double time_s,
                                                          stylet_rt_pose* base) STYLET_RT_NOEXCEPT;

/* Warnings about a step (stylet_rt_result.flags), each with the cure. */
#define STYLET_RT_NOT_CONVERGED UINT32_C(0x01)   /* no balance found, do not trust the force: use a smaller dt */
#define STYLET_RT_CONTACT_CYCLING UINT32_C(0x02) /* a contact's state was frozen for one sub-step: nothing to do */
#define STYLET_RT_COMPLIANCE_MISSING \
  UINT32_C(0x04) /* the tip left the prepared corridor: prepare; tip in the air: draw out */
#define STYLET_RT_OUT_OF_CONTACTS UINT32_C(0x08)   /* a piece of shaft has no contact: raise coupling.contacts */
#define STYLET_RT_TOO_FAST UINT32_C(0x10)          /* the base moved too far in one step: smaller dt or speed */
#define STYLET_RT_INVALID_INPUT UINT32_C(0x20)     /* the step was not taken: pose or dt is invalid */
#define STYLET_RT_NO_CONTACT_INSIDE UINT32_C(0x40) /* the tip is inside without any contact: draw it out */
#define STYLET_RT_UNUSABLE_LAW UINT32_C(0x80)      /* never set for a saved model: a C++ program's own law failed */
/* If any of these flags is set, the force must not be sent to a device. */
#define STYLET_RT_DISTRUSTED (STYLET_RT_NOT_CONVERGED | STYLET_RT_INVALID_INPUT)

/* State of the tip (stylet_rt_result.tip_state). */
enum {
  STYLET_RT_TIP_AIR = 0,      /* outside the patient */
  STYLET_RT_TIP_PRESSING = 1, /* touches tissue and does not cut it */
  STYLET_RT_TIP_CUTTING = 2,
  STYLET_RT_TIP_IN_TRACK = 3, /* in tissue already cut */
  STYLET_RT_TIP_BONE = 4,     /* against a rigid region */
  STYLET_RT_TIP_EXITED = 5    /* through the far side */
};

/* Result of a step. The "hand" holds the base; a haptic device has to exert the opposite of its force. 200 bytes. */
typedef struct stylet_rt_result {
  double time_s;             /* simulated time since the simulation was created */
  double base_depth_mm;      /* distance of the tip of a rigid straight needle beyond the entry point */
  double hand_force_N[3];    /* LPS, exerted by the hand on the base */
  double hand_torque_Nmm[3]; /* LPS, about the base point */
  double force_axial_N;      /* hand force along the base's axis, positive when pushing in */
  double force_lateral_N;    /* hand force across the axis, towards the patient's left */
  double force_sagittal_N;   /* hand force in the direction axial x lateral */
  double guide_force_N[3];   /* LPS, exerted by a guide template on the shaft */
  double base_mm[3];         /* LPS, position of the base */
  double tip_mm[3];          /* LPS */
  double inserted_mm;        /* length of shaft in tissue */
  double sliding_share;      /* share of inserted_mm that slides along the tissue, 0 ... 1 */
  uint32_t flags;            /* STYLET_RT_NOT_CONVERGED, ...; 0 = no warning */
  int32_t tip_state;         /* STYLET_RT_TIP_AIR, ... */
  int32_t contacts;          /* number of contacts; includes the tip if it touches tissue */
  int32_t sticking;          /* number of contacts that stick */
  int32_t iterations;        /* iterations of the solver, summed over the sub-steps */
  int32_t events;            /* number of events of this step, see stylet_rt_sim_read_events */
} stylet_rt_result;

/* Moves the base to `base` in dt_s seconds and finds the balance of needle and tissue. [real time]
 * @param dt_s 1e-9 ... 1; rounded to whole nanoseconds
 * @param result output, may be null. For an invalid pose or dt (STYLET_RT_BAD_ARGUMENT) it is the result of the last
 *        step with STYLET_RT_INVALID_INPUT added and without events; on any other failure it is unchanged
 * @return STYLET_RT_OK regardless of the flags */
STYLET_RT_API stylet_rt_status stylet_rt_sim_step(stylet_rt_sim* sim, const stylet_rt_pose* base, double dt_s,
                                                  stylet_rt_result* result) STYLET_RT_NOEXCEPT;

/* Reads the result of the last step again; after placing the needle, a result with forces of zero. [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_result(const stylet_rt_sim* sim,
                                                         stylet_rt_result* result) STYLET_RT_NOEXCEPT;

/* Makes compliance around the tip available if the needle has left the prepared corridor; otherwise returns at once.
 * Allocates and solves; the first time it factorises the tissue, which takes as long as in `stylet prepare`. With
 * STYLET_RT_WORKER it waits for the worker instead. Call it between steps, and not from a loop with deadlines. */
STYLET_RT_API stylet_rt_status stylet_rt_sim_prepare(stylet_rt_sim* sim, char* error,
                                                     size_t error_size) STYLET_RT_NOEXCEPT;

/* ---- state for display and recording ----------------------------------------------------------------------------- */

/* A contact: a place where needle and tissue hold each other. 72 bytes. */
typedef struct stylet_rt_contact {
  double position_mm[3]; /* LPS, of the tissue's point, deformed */
  double force_N[3];     /* LPS, on the tissue */
  double s_mm;           /* arc length on the needle, from the base */
  double length_mm;      /* length of shaft that the contact represents */
  int32_t sticking;      /* 1 = sticks, 0 = slides */
  int32_t tip;           /* 1 for the tip */
} stylet_rt_contact;

/* Reads the present contacts; the tip is first if it touches tissue. [real time]
 * @param contacts output, with room for `room` contacts; may be null with room = 0
 * @param count output: number of contacts; contacts beyond `room` are not written */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_contacts(stylet_rt_sim* sim, stylet_rt_contact* contacts, size_t room,
                                                           size_t* count) STYLET_RT_NOEXCEPT;

/* Reads the needle's centreline. [real time; a few microseconds for a hundred points]
 * @param points_mm (points) x, y, z LPS, evenly spaced from the base to the tip
 * @param points at least 2 */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_needle(const stylet_rt_sim* sim, double* points_mm,
                                                         size_t points) STYLET_RT_NOEXCEPT;

/* Reads the centreline of any needle that has been taken up, one at rest included. [real time; as read_needle] */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_needle_of(const stylet_rt_sim* sim, int32_t needle, double* points_mm,
                                                            size_t points) STYLET_RT_NOEXCEPT;

/* Kinds of events. */
enum {
  STYLET_RT_EVENT_SKIN_CONTACT = 0,     /* the tip touches the skin */
  STYLET_RT_EVENT_PUNCTURE = 1,         /* the surface in front of the tip breaks */
  STYLET_RT_EVENT_REGION_ENTERED = 2,   /* the tip enters a region */
  STYLET_RT_EVENT_RETRACTION_START = 3, /* the base begins to move outwards */
  STYLET_RT_EVENT_SLIP_START = 4,       /* after a turn outwards, most of the shaft slides out and the hand pulls */
  STYLET_RT_EVENT_WITHDRAWN = 5,        /* the needle has been drawn out of the patient */
  STYLET_RT_EVENT_BONE_CONTACT = 6,     /* the tip touches a rigid region */
  STYLET_RT_EVENT_EXITED = 7,           /* the tip leaves the tissue through the far side */
  STYLET_RT_EVENT_RE_ENTERED = 8,       /* the tip touches tissue again after it had exited */
  STYLET_RT_EVENT_GRAZED = 9            /* the tip slides off a surface that it meets at a grazing angle */
};

/* An event. 32 bytes. */
typedef struct stylet_rt_event {
  double time_s;   /* simulated time */
  double depth_mm; /* base depth */
  double force_N;  /* axial force of the hand at that moment */
  int32_t kind;    /* STYLET_RT_EVENT_SKIN_CONTACT, ... */
  int32_t region;  /* region touched, punctured or entered; -1 if the event has none */
} stylet_rt_event;

/* Largest number of events in a step. */
#define STYLET_RT_MAX_EVENTS 24

/* Reads the events of the last step, in their order. [real time]
 * @param events output, with room for `room` events; may be null with room = 0
 * @param count output: number of events; events beyond `room` are not written */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_events(const stylet_rt_sim* sim, stylet_rt_event* events, size_t room,
                                                         size_t* count) STYLET_RT_NOEXCEPT;

/* Capacities that are allocated before the first step, since steps do not allocate. */
enum {
  STYLET_RT_CAPACITY_CONTACTS = 0,    /* contacts on the shaft; beyond it: STYLET_RT_OUT_OF_CONTACTS */
  STYLET_RT_CAPACITY_SPARE_NODES = 1, /* nodes with compliance computed during motion; beyond it the furthest lose it */
  STYLET_RT_CAPACITY_TRACKS = 2,      /* tracks of earlier insertions; beyond it the oldest is forgotten */
  STYLET_RT_CAPACITY_EVENTS = 3       /* events of needle and tissue in one step; further events are dropped */
};

/* Use of a capacity. 8 bytes. */
typedef struct stylet_rt_capacity {
  int32_t most; /* largest number in use at a time since the simulation was created */
  int32_t room; /* the capacity */
} stylet_rt_capacity;

/* Reads the use of a capacity. [real time]
 * @param which STYLET_RT_CAPACITY_CONTACTS, ... */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_capacity(const stylet_rt_sim* sim, int32_t which,
                                                           stylet_rt_capacity* capacity) STYLET_RT_NOEXCEPT;

/* ---- displaced surfaces ------------------------------------------------------------------------------------------ */

/* The surfaces of a patient, for pictures: where the needles have moved the skin and the surfaces between regions. A
 * display belongs to one model and serves any number of its simulations; only one thread at a time may use it, which
 * need not be that of the loop. */
typedef struct stylet_rt_display stylet_rt_display;

/* Prepares a display: solves for columns of the tissue's response, which takes seconds and factorises the tissue if
 * that has not been done. STYLET_RT_INPUT_ERROR: the model's engine keeps no compliance for it.
 * @param display output, or null on failure. To be released with stylet_rt_display_destroy */
STYLET_RT_API stylet_rt_status stylet_rt_display_create(const stylet_rt_model* model, stylet_rt_display** display,
                                                        char* error, size_t error_size) STYLET_RT_NOEXCEPT;
/* Releases a display. Null is allowed. */
STYLET_RT_API void stylet_rt_display_destroy(stylet_rt_display* display) STYLET_RT_NOEXCEPT;

/* A triangle. The corners are in the sense of a normal that points from inside to outside. 20 bytes. */
typedef struct stylet_rt_triangle {
  int32_t corner[3]; /* numbers of points, see stylet_rt_display_read_points */
  int32_t inside;    /* region on the side from which the normal points, see stylet_rt_model_region */
  int32_t outside;   /* region on the other side; -1 = outside of the patient */
} stylet_rt_triangle;

/* Reads the triangles, which never change. [real time]
 * @param triangles output, with room for `room`; may be null with room = 0
 * @param count output: number of triangles; those beyond `room` are not written
 * @param points output: number of points that the corners number; may be null */
STYLET_RT_API stylet_rt_status stylet_rt_display_read_triangles(const stylet_rt_display* display,
                                                                stylet_rt_triangle* triangles, size_t room,
                                                                size_t* count, size_t* points) STYLET_RT_NOEXCEPT;

/* Takes the forces of a simulation's last step. [real time] The display must not be read meanwhile.
 * STYLET_RT_BAD_ARGUMENT: the simulation is one of another model */
STYLET_RT_API stylet_rt_status stylet_rt_display_take(stylet_rt_display* display,
                                                      const stylet_rt_sim* sim) STYLET_RT_NOEXCEPT;

/* Computes where the points lie under the forces that were taken last; before, where they lie at rest. Its time grows
 * with the number of points, and it may allocate: not in the loop.
 * @param points_mm output (points) x, y, z LPS
 * @param points room, at least the number of points
 * @param left_out_N output: sum of the forces that are not shown, because they act away from the planned paths; may be
 *        null */
STYLET_RT_API stylet_rt_status stylet_rt_display_read_points(stylet_rt_display* display, double* points_mm,
                                                             size_t points, double* left_out_N) STYLET_RT_NOEXCEPT;

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
