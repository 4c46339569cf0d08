/* The link between Calcine's coordinator and a solver, as C sees it.
 *
 * A solver's rank opens its link, shakes hands, sends its first state, and then answers:
 *
 *   calcine_link_open(rank, carrier, &link)      what to open stands in the variable CALCINE_LINK
 *   calcine_link_handshake(link, &hello, 10000)  compares versions, hashes, catalogue, count
 *   loan(CALCINE_OWNED) … send                   a gas: which cells of the whole mesh this rank has
 *   loan(CALCINE_STATE) … send                   the state that the run starts from
 *   loop: calcine_link_receive
 *     CALCINE_START       compute one attempt from the last commit; answer CALCINE_FINISHED
 *     CALCINE_COMMIT      take the last attempt as the start of the next; no answer
 *     CALCINE_CHECKPOINT  write into the directory that calcine_link_text gives, re-initialise from
 *                         what was written; answer CALCINE_CHECKPOINTED with the state
 *     CALCINE_BOUNDARY    conditions of patches from the next window on: a text with a line each, patch,
 *                         condition and values; answer CALCINE_BOUNDARY without columns
 *     CALCINE_BYE         answer CALCINE_BYE, close the link, exit with 0
 *
 * The next request may arrive before the answer to the last one only after CALCINE_COMMIT.
 * All numbers are SI. A link belongs to one thread at a time. Link with
 *   libcalcine_wire.a -lgcc_s -lutil -lrt -lpthread -lm -ldl
 */
#ifndef CALCINE_WIRE_H
#define CALCINE_WIRE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the protocol; both sides must have the same. */
#define CALCINE_WIRE_VERSION 3u

/* One end of a link. */
typedef struct calcine_link calcine_link;

/* How a call ended. */
typedef enum calcine_status {
    CALCINE_OK = 0,
    CALCINE_TIMEOUT = 1,   /* nothing arrived in time; not an error */
    CALCINE_PEER_DEAD = 2, /* the coordinator died; its files are removed: exit at once */
    CALCINE_ERROR = 3,     /* see calcine_last_error */
    CALCINE_PANIC = 4      /* a defect in Calcine; see calcine_last_error */
} calcine_status;

/* What a message is. */
typedef enum calcine_kind {
    CALCINE_HELLO = 1,
    CALCINE_STATE = 2,
    CALCINE_START = 3,
    CALCINE_FINISHED = 4,
    CALCINE_COMMIT = 5,
    CALCINE_CHECKPOINT = 6,
    CALCINE_CHECKPOINTED = 7,
    CALCINE_FAILED = 8,
    CALCINE_BYE = 9,
    CALCINE_OWNED = 10,
    CALCINE_BOUNDARY = 13
} calcine_kind;

/* What stands before the columns of a message. Times in ticks of 1e-12 s. */
typedef struct calcine_header {
    uint64_t magic;        /* "calcine\1" */
    uint32_t version;      /* CALCINE_WIRE_VERSION */
    uint32_t kind;         /* calcine_kind */
    uint64_t run;          /* the run that the message belongs to */
    uint32_t rank;         /* the solver's rank */
    uint32_t attempt;      /* 0 for the first attempt of a window */
    uint64_t window;       /* windows committed before this one */
    int64_t start_motion;  /* motion clock at the start of the window */
    int64_t start_process; /* process clock at the start of the window */
    int64_t span_motion;   /* how far the motion clock moves */
    int64_t span_process;  /* how far the process clock moves */
    int64_t storage_span;  /* over which the gas stores mass, enthalpy, species */
    uint64_t count;        /* cells or particles in the columns */
    uint64_t bytes;        /* bytes of the payload: columns, or text */
} calcine_header;

/* What a solver says of itself in the handshake. Texts end with a zero byte; a hash is any text that
 * both sides derive from the same thing. */
typedef struct calcine_hello {
    const char *role;      /* "gas" or "particles" */
    const char *name;      /* for example "OpenFOAM" */
    const char *version;   /* of the solver */
    const char *case_hash; /* of the case that the inputs were written for */
    const char *mesh_hash; /* of the mesh (gas) or of the initial particles */
    const char *catalogue; /* NULL: the standard catalogue of the role; else one field a line */
    uint64_t count;        /* cells or particles of all ranks */
    uint32_t ranks;        /* ranks of the solver */
} calcine_hello;

/* Standard catalogue of the role "gas" (name, components, unit; one value per cell unless noted):
 *   received with CALCINE_START:
 *     void_fraction 1 [1], drag_coefficient 1 [kg/s], drag_source 3 [N],
 *     heat_coefficient 1 [W/K], heat_source 1 [W]
 *   sent once, with CALCINE_OWNED:
 *     cell 1 [u64]: numbers in the whole mesh, in the order of all other columns
 *   sent with CALCINE_STATE, CALCINE_FINISHED, CALCINE_CHECKPOINTED:
 *     heat 1 [W], drag 3 [N], temperature 1 [K], pressure 1 [Pa], density 1 [kg/m^3],
 *     velocity 3 [m/s], pressure_gradient 3 [Pa/m],
 *     balances 35 numbers: mass, energy, momentum x, y, z (kg, J, N s), each as stored,
 *       stored_magnitude, boundary, boundary_magnitude, exchange, source, source_magnitude,
 *     convergence 5 numbers: outer_iterations, linear_iterations, residual, volume_residual,
 *       converged (1 or 0)
 * A gas of N species adds (calcine_hello.catalogue then has all lines): composition N [1] per cell, mass
 * fractions, and N more balances, in kg of each species, after the momentum's.
 * A vector column is interleaved: x, y, z of the first cell, then of the second. Every column starts
 * at a multiple of 64 bytes. With CALCINE_STATE and CALCINE_CHECKPOINTED, `heat`, `drag`, `balances`
 * and `convergence` are zero. */

/* What moves messages where the coordinator started the ranks by MPI: functions of the solver, over the
 * intercommunicator to its parent. None may block; a negative result is an error's code. */
typedef struct calcine_carrier {
    void *context;
    /* Begins to send; the words stay until `pending` no longer counts the message. */
    int64_t (*post)(void *context, const uint64_t *words, uint64_t count);
    /* Moves on what was posted; messages that the coordinator has not taken, in order. */
    int64_t (*pending)(void *context);
    /* Words of the next message that waits here; 0: none. */
    int64_t (*arrived)(void *context);
    /* Takes the message that waits into as many words. */
    int64_t (*take)(void *context, uint64_t *words, uint64_t count);
} calcine_carrier;

/* Whether the link that the variable CALCINE_LINK describes needs a carrier: 1 or 0. */
calcine_status calcine_link_needs_carrier(uint32_t *needs);

/* Opens the link of a rank, as the variable CALCINE_LINK describes it; `carrier` may be NULL where
 * none is needed. */
calcine_status calcine_link_open(uint32_t rank, const calcine_carrier *carrier,
                                 calcine_link **link);

/* Says hello and compares with what the coordinator answers; an error names both values. */
calcine_status calcine_link_handshake(calcine_link *link, const calcine_hello *hello,
                                      uint32_t timeout_ms);

/* Waits for the next message; what was received before becomes invalid. `payload` and `bytes` may be
 * NULL. CALCINE_TIMEOUT where nothing arrived. */
calcine_status calcine_link_receive(calcine_link *link, uint32_t timeout_ms,
                                    calcine_header *header, const void **payload,
                                    uint64_t *bytes);

/* A column of the message received last: pointer into shared memory, number of doubles. A column of
 * unit "u64" holds 64-bit integers: cast the pointer. Valid until the next receive or close. */
calcine_status calcine_link_column(calcine_link *link, const char *name, const double **values,
                                   uint64_t *length);

/* Text of the message received last (CALCINE_CHECKPOINT: an absolute directory). */
calcine_status calcine_link_text(calcine_link *link, const char **text);

/* Reserves the next message of a kind with columns for `count` cells or particles. Window, attempt
 * and clocks are those of the message received last. Columns are for Finished, State, Checkpointed, Owned;
 * other kinds have none. */
calcine_status calcine_link_loan(calcine_link *link, calcine_kind kind, uint64_t count);

/* A column of the reserved message, to be filled in place. Every column must be asked for, and
 * filled, before the message is sent. */
calcine_status calcine_link_loaned_column(calcine_link *link, const char *name, double **values,
                                          uint64_t *length);

/* Sends the reserved message. */
calcine_status calcine_link_send(calcine_link *link);

/* Tells the coordinator that the solver failed, in one sentence; then close and exit. */
calcine_status calcine_link_failed(calcine_link *link, const char *text);

/* What went wrong in this thread's last call that did not return CALCINE_OK; never NULL. */
const char *calcine_last_error(void);

/* Closes the link; NULL is allowed. */
void calcine_link_close(calcine_link *link);

#ifdef __cplusplus
}
#endif

#endif
