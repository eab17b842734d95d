/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stylet from C: a flexible needle in soft tissue, step by step, in the caller's own real-time loop.
 *
 *   load a saved model (stylet prepare)  ->  create a simulation  ->  step, step, step  ->  destroy both
 *
 * A model is what takes long to compute. It does not change and may be shared by simulations in several threads. A
 * simulation is one needle in it; one thread at a time may use it. examples/rt_loop.c is a complete program.
 *
 * Units are mm, N, s, rad. Coordinates are the patient's, DICOM LPS: +x left, +y posterior, +z superior. The needle
 * leaves its base along the base's local z axis.
 *
 * Real time: functions marked [real time] neither allocate, lock, wait, call the operating system, log nor throw, and
 * their time does not depend on the size of the mesh. All others are for before, between and after. docs/realtime.md
 * tells how to run the loop on a hard real-time system.
 *
 * Errors: functions that can fail return a status, 0 = STYLET_RT_OK. Null and out-of-range arguments are statuses too.
 * No C++ exception leaves the library. Where a function takes `error` and `error_size`, it writes there what is wrong,
 * where, and the cure, in one line that ends in a zero and is cut to fit; the empty line when all went well. Both may
 * be 0. What a function writes through pointers is left as it was when it fails, unless it says otherwise.
 *
 * Binary interface: numbers have fixed widths and structures no hidden padding. A change that breaks programs raises
 * STYLET_RT_ABI_VERSION and the number in the library's file name; new functions do not.
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

/* The STYLET_RT_ABI_VERSION that the library was built with: compare it with the header's. [real time] */
STYLET_RT_API uint32_t stylet_rt_abi_version(void) STYLET_RT_NOEXCEPT;

/* Version of Stylet, e.g. "0.1.0". [real time] */
STYLET_RT_API const char* stylet_rt_version(void) STYLET_RT_NOEXCEPT;

/* ---- statuses ---------------------------------------------------------------------------------------------------- */

typedef int32_t stylet_rt_status;
enum {
  STYLET_RT_OK = 0,
  STYLET_RT_FAILED = 1,       /* the input may be right, but it could not be done */
  STYLET_RT_INPUT_ERROR = 2,  /* a file or a setting is wrong: the message names the place, the value and the cure */
  STYLET_RT_BAD_ARGUMENT = 3, /* null, out of range, not finite, or a structure of unknown size */
  STYLET_RT_OUT_OF_MEMORY = 4
};

/* A few words for a status. [real time] */
STYLET_RT_API const char* stylet_rt_status_text(stylet_rt_status status) STYLET_RT_NOEXCEPT;

/* ---- model ------------------------------------------------------------------------------------------------------- */

typedef struct stylet_rt_model stylet_rt_model;

/* Loads a saved model (`stylet prepare SCENARIO.toml -o MODEL.stylet`). A file of which any bit has changed is refused.
 * The scenario's text in it and the settings are parsed in a child process, which has ended when this returns.
 * @param settings keys of the scenario to change, "needle.length_mm=180", as --set of `stylet insert` takes them; those
 *        that the saved compliance depends on are refused. May be null with settings_count = 0
 * @param model written: the model, or null when it could not be loaded. To be given to stylet_rt_model_destroy */
STYLET_RT_API stylet_rt_status stylet_rt_model_load(const char* path, const char* const* settings,
                                                    size_t settings_count, stylet_rt_model** model, char* error,
                                                    size_t error_size) STYLET_RT_NOEXCEPT;

/* Simulations of it may go on; the memory goes with the last of them. Null is allowed. */
STYLET_RT_API void stylet_rt_model_destroy(stylet_rt_model* model) STYLET_RT_NOEXCEPT;

/* What a model is like. 64 bytes. */
typedef struct stylet_rt_model_info {
  double needle_length_mm;
  double needle_diameter_mm;
  double dt_s;          /* time step of the scenario (run.dt_ms); a loop may use another */
  double corridor_mm;   /* radius around the planned ways within which the compliance is there from the start */
  int32_t nodes;        /* of the mesh */
  int32_t tets;         /* of the mesh */
  int32_t regions;      /* of the mesh, see stylet_rt_model_region */
  int32_t insertions;   /* planned, see stylet_rt_model_insertion */
  int32_t max_contacts; /* places where needle and tissue hold each other, tip included: room for them all */
  int32_t reserved[3];  /* 0 */
} stylet_rt_model_info;

/* [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_model_read_info(const stylet_rt_model* model,
                                                         stylet_rt_model_info* info) STYLET_RT_NOEXCEPT;

/* Name of region 0 ... regions - 1, e.g. "prostate"; lives as long as the model. Null for any other. [real time] */
STYLET_RT_API const char* stylet_rt_model_region(const stylet_rt_model* model, int32_t region) STYLET_RT_NOEXCEPT;

/* A planned insertion. 64 bytes. */
typedef struct stylet_rt_insertion {
  double entry_mm[3];  /* LPS, skin point on the needle's line */
  double direction[3]; /* LPS, unit vector, into the patient */
  double depth_mm;     /* how far the base goes on after the tip of a straight needle is at the entry */
  double duration_s;   /* of the planned motion: in, stay, and out, as the scenario has it */
} stylet_rt_insertion;

/* [real time] @param index 0 ... insertions - 1 */
STYLET_RT_API stylet_rt_status stylet_rt_model_insertion(const stylet_rt_model* model, int32_t index,
                                                         stylet_rt_insertion* insertion) STYLET_RT_NOEXCEPT;

/* Name of a planned insertion, its template hole or "needle 1", ...; lives as long as the model. Null for an index
 * out of range. [real time] */
STYLET_RT_API const char* stylet_rt_model_insertion_name(const stylet_rt_model* model,
                                                         int32_t index) STYLET_RT_NOEXCEPT;

/* ---- simulation -------------------------------------------------------------------------------------------------- */

typedef struct stylet_rt_sim stylet_rt_sim;

/* How a simulation is created. Set struct_size and leave the rest 0 for the defaults; later versions may add members
 * at the end, whose default is 0. 16 bytes. */
typedef struct stylet_rt_options {
  uint32_t struct_size; /* sizeof(stylet_rt_options) */
  int32_t insertion;    /* planned insertion to start at */
  uint32_t flags;       /* STYLET_RT_KEEP_DENORMALS, STYLET_RT_WORKER */
  uint32_t reserved;    /* 0 */
} stylet_rt_options;

/* A step leaves the processor's treatment of denormal numbers alone. Without it a step sets them to count as zero and
 * puts the former mode back at its end (x86, 64-bit ARM); with them a step can take many times as long. */
#define STYLET_RT_KEEP_DENORMALS UINT32_C(1)

/* A thread of the library's own, with ordinary scheduling, lives as long as the simulation and keeps compliance ahead
 * of the tip where the needle leaves the prepared corridor. Steps stay what they are: they find there what it has made.
 * The first time it factorises the tissue, which takes as long as that took `stylet prepare`, and as much memory. */
#define STYLET_RT_WORKER UINT32_C(2)

/* Creates a needle at the start of a planned insertion, outside the patient. All memory its steps use is taken here.
 * @param options null for the defaults
 * @param sim written: the simulation, or null when there is none. To be given to stylet_rt_sim_destroy */
STYLET_RT_API stylet_rt_status stylet_rt_sim_create(const stylet_rt_model* model, const stylet_rt_options* options,
                                                    stylet_rt_sim** sim, char* error,
                                                    size_t error_size) STYLET_RT_NOEXCEPT;

/* Null is allowed. With STYLET_RT_WORKER it waits until that has ended what it is at, were it the factor. */
STYLET_RT_API void stylet_rt_sim_destroy(stylet_rt_sim* sim) STYLET_RT_NOEXCEPT;

/* Where the base is. 56 bytes. */
typedef struct stylet_rt_pose {
  double position_mm[3]; /* LPS */
  double rotation[4];    /* unit quaternion w, x, y, z: base to LPS. Up to 1e-3 off unit length is put right */
} stylet_rt_pose;

/* Puts the needle back outside the patient, straight, at the start of a planned insertion; the tissue keeps the tracks
 * that were cut. Simulated time goes on. @param insertion 0 ... insertions - 1 */
STYLET_RT_API stylet_rt_status stylet_rt_sim_place(stylet_rt_sim* sim, int32_t insertion) STYLET_RT_NOEXCEPT;

/* Where the plan has the base, `time_s` after the start of the insertion placed last; it stands still before its start
 * and after its end. [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_sim_planned_base(const stylet_rt_sim* sim, double time_s,
                                                          stylet_rt_pose* base) STYLET_RT_NOEXCEPT;

/* What a step has to say of itself (stylet_rt_result.flags), and what to do. */
#define STYLET_RT_NOT_CONVERGED UINT32_C(0x01)   /* no balance found, the force is not the model's: smaller dt */
#define STYLET_RT_CONTACT_CYCLING UINT32_C(0x02) /* a contact was kept as it was for one sub-step: nothing to do */
#define STYLET_RT_COMPLIANCE_MISSING \
  UINT32_C(0x04)                                 /* the tip left the prepared corridor: prepare; in the air: draw out */
#define STYLET_RT_OUT_OF_CONTACTS UINT32_C(0x08) /* forces miss a piece of shaft: raise coupling.contacts */
#define STYLET_RT_TOO_FAST UINT32_C(0x10)        /* the base moved too far for one step: smaller dt, or slower */
#define STYLET_RT_INVALID_INPUT UINT32_C(0x20)   /* the step was not taken: pose or dt are no good */
#define STYLET_RT_NO_CONTACT_INSIDE UINT32_C(0x40) /* the tip is inside, but nothing holds it: draw it out */
#define STYLET_RT_UNUSABLE_LAW UINT32_C(0x80) /* never of a saved model: a C++ program's own law of cutting failed */
/* With any of these the force must not reach a hand. */
#define STYLET_RT_DISTRUSTED (STYLET_RT_NOT_CONVERGED | STYLET_RT_INVALID_INPUT)

/* What the tip does (stylet_rt_result.tip_state). */
enum {
  STYLET_RT_TIP_AIR = 0,      /* outside the patient */
  STYLET_RT_TIP_PRESSING = 1, /* touches tissue it does not cut (yet) */
  STYLET_RT_TIP_CUTTING = 2,
  STYLET_RT_TIP_IN_TRACK = 3, /* in tissue already cut */
  STYLET_RT_TIP_BONE = 4,     /* against a rigid region */
  STYLET_RT_TIP_EXITED = 5    /* through the far side */
};

/* What a step came to. "Hand" is whatever holds the base: what a haptic device has to show is the opposite. 200 bytes.
 */
typedef struct stylet_rt_result {
  double time_s;             /* simulated, since the simulation was created */
  double base_depth_mm;      /* how far the tip of a rigid straight needle would be beyond the entry point */
  double hand_force_N[3];    /* LPS, exerted by the hand on the base */
  double hand_torque_Nmm[3]; /* LPS, about the base point */
  double force_axial_N;      /* of the hand, along the base's axis, positive when pushing in */
  double force_lateral_N;    /* of the hand, towards patient left, across the axis */
  double force_sagittal_N;   /* of the hand, axial x lateral */
  double guide_force_N[3];   /* LPS, exerted by a guide template on the shaft */
  double base_mm[3];         /* LPS, where the base is */
  double tip_mm[3];          /* LPS */
  double inserted_mm;        /* length of shaft in tissue */
  double sliding_share;      /* 0 ... 1 of it that slides along the tissue */
  uint32_t flags;            /* STYLET_RT_NOT_CONVERGED, ... of this step; 0 = all is well */
  int32_t tip_state;         /* STYLET_RT_TIP_AIR, ... */
  int32_t contacts;          /* tip included when it touches */
  int32_t sticking;          /* of them */
  int32_t iterations;        /* of the solver */
  int32_t events;            /* of this step, see stylet_rt_sim_read_events */
} stylet_rt_result;

/* Moves the base to `base` in dt_s seconds and finds the balance of needle and tissue. [real time]
 * @param dt_s at least 1e-9, at most 1; taken as a whole number of nanoseconds
 * @param result written, may be null. Of a pose or dt that is no good (STYLET_RT_BAD_ARGUMENT): what the last step came
 *        to, with STYLET_RT_INVALID_INPUT and no events. Not written otherwise where a status is returned
 * @return STYLET_RT_OK whatever the flags say */
STYLET_RT_API stylet_rt_status stylet_rt_sim_step(stylet_rt_sim* sim, const stylet_rt_pose* base, double dt_s,
                                                  stylet_rt_result* result) STYLET_RT_NOEXCEPT;

/* The result again: of the last step, or of the placing, with forces of zero. [real time] */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_result(const stylet_rt_sim* sim,
                                                         stylet_rt_result* result) STYLET_RT_NOEXCEPT;

/* Makes compliance around the tip available where the needle has left the prepared corridor, and returns at once where
 * it has not. Allocates and solves; the first time it factorises the tissue, which takes as long as that took `stylet
 * prepare`. With STYLET_RT_WORKER it waits for the worker instead. Between steps, and not from a loop that has a
 * deadline. */
STYLET_RT_API stylet_rt_status stylet_rt_sim_prepare(stylet_rt_sim* sim, char* error,
                                                     size_t error_size) STYLET_RT_NOEXCEPT;

/* ---- what there is to see ---------------------------------------------------------------------------------------- */

/* A place where needle and tissue hold each other. 72 bytes. */
typedef struct stylet_rt_contact {
  double position_mm[3]; /* LPS, of the tissue's point, deformed */
  double force_N[3];     /* LPS, on the tissue */
  double s_mm;           /* arc length on the needle, from the base */
  double length_mm;      /* length of shaft it stands for */
  int32_t sticking;      /* 1, or 0 where it slides */
  int32_t tip;           /* 1 for the tip */
} stylet_rt_contact;

/* The contacts now, the tip first when it touches. [real time]
 * @param contacts room for `room` of them; may be null with room = 0
 * @param count written: how many there are; those beyond room are left out */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_contacts(stylet_rt_sim* sim, stylet_rt_contact* contacts, size_t room,
                                                           size_t* count) STYLET_RT_NOEXCEPT;

/* The needle's centreline. [real time; a few microseconds for a hundred points]
 * @param points_mm (points) x, y, z LPS, evenly spaced from the base to the tip
 * @param points at least 2 */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_needle(const stylet_rt_sim* sim, double* points_mm,
                                                         size_t points) STYLET_RT_NOEXCEPT;

/* Things that happen. */
enum {
  STYLET_RT_EVENT_SKIN_CONTACT = 0,
  STYLET_RT_EVENT_PUNCTURE = 1,
  STYLET_RT_EVENT_REGION_ENTERED = 2,
  STYLET_RT_EVENT_RETRACTION_START = 3,
  STYLET_RT_EVENT_SLIP_START = 4, /* after a reversal more than half of the shaft has begun to slide */
  STYLET_RT_EVENT_WITHDRAWN = 5,
  STYLET_RT_EVENT_BONE_CONTACT = 6,
  STYLET_RT_EVENT_EXITED = 7,
  STYLET_RT_EVENT_RE_ENTERED = 8,
  STYLET_RT_EVENT_GRAZED = 9
};

/* 32 bytes. */
typedef struct stylet_rt_event {
  double time_s;   /* simulated */
  double depth_mm; /* of the base */
  double force_N;  /* of the hand, axial, at that moment */
  int32_t kind;    /* STYLET_RT_EVENT_SKIN_CONTACT, ... */
  int32_t region;  /* touched, punctured or entered; -1 where it has no meaning */
} stylet_rt_event;

/* At most so many happen in a step. */
#define STYLET_RT_MAX_EVENTS 24

/* The events of the last step, in their order. [real time]
 * @param events room for `room` of them; may be null with room = 0
 * @param count written: how many there are; those beyond room are left out */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_events(const stylet_rt_sim* sim, stylet_rt_event* events, size_t room,
                                                         size_t* count) STYLET_RT_NOEXCEPT;

/* Room that was set aside before the first step, since no step allocates. */
enum {
  STYLET_RT_CAPACITY_CONTACTS = 0,    /* on the shaft; one more: STYLET_RT_OUT_OF_CONTACTS */
  STYLET_RT_CAPACITY_SPARE_NODES = 1, /* whose compliance came while the needle moved; for more the furthest go */
  STYLET_RT_CAPACITY_TRACKS = 2,      /* of earlier insertions; for one more the oldest is forgotten */
  STYLET_RT_CAPACITY_EVENTS = 3       /* of needle and tissue in one step; further ones are not told */
};

/* 8 bytes. */
typedef struct stylet_rt_capacity {
  int32_t most; /* that was ever in use since the simulation was created */
  int32_t room;
} stylet_rt_capacity;

/* How much of it was needed. [real time]
 * @param which STYLET_RT_CAPACITY_CONTACTS, ... */
STYLET_RT_API stylet_rt_status stylet_rt_sim_read_capacity(const stylet_rt_sim* sim, int32_t which,
                                                           stylet_rt_capacity* capacity) STYLET_RT_NOEXCEPT;

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */

#endif
