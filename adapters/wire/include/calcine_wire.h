/* The link between Calcine's coordinator and a solver, as C sees it.
 *
 * A rank of a solver opens its link, shakes hands, sends its first state, and then answers requests:
 *
 *   calcine_link_open(rank, carrier, &link)      what to open stands in the variable CALCINE_LINK
 *   calcine_link_handshake(link, &hello, 10000)  compares versions, hashes, catalogue, count
 *   loan(CALCINE_OWNED) … send                   a gas: which cells of the whole mesh this rank has
 *   loan(CALCINE_STATE) … send                   the state that the run starts from
 *   loop: calcine_link_receive                   answer as the table of messages below says
 *
 * The next request may arrive before the answer to the last one only after CALCINE_COMMIT.
 * docs/attach-a-solver.md walks through a solver, examples/column_gas.c.
 *
 * All numbers are SI. A vector column is interleaved: x, y, z of the first item, then of the second. Every column
 * starts at a multiple of 64 bytes; one of unit "u64" holds 64-bit integers. The signs of an exchange are those of
 * the gas: + is into it. A balance is over the storage span (momentum: the motion span), and what is stored less
 * boundary, exchange and source is 0.
 *
 * A link belongs to one thread at a time. Link with
 *   libcalcine_wire.a -lgcc_s -lutil -lrt -lpthread -lm -ldl
 */
#ifndef CALCINE_WIRE_H
#define CALCINE_WIRE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

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

/* Generated from the catalogue: adapters/wire/src/reference.rs. */

/* Version of the protocol; both sides must have the same. */
#define CALCINE_WIRE_VERSION 4u

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
    CALCINE_CHANGE = 11,
    CALCINE_CHANGED = 12,
    CALCINE_BOUNDARY = 13,
    CALCINE_COMMITTED = 14
} calcine_kind;

/* Why a solver cannot go on. */
typedef enum calcine_failure {
    CALCINE_FAILURE_OTHER = 0,           /* none of the others */
    CALCINE_FAILURE_DIVERGED = 1,        /* the solution left what is physical */
    CALCINE_FAILURE_NOT_CONVERGED = 2,   /* an iteration ended at its limit, above its tolerance */
    CALCINE_FAILURE_INPUT = 3,           /* what the solver was told, or its own inputs, are outside its range */
    CALCINE_FAILURE_LOST_PARTICLES = 4,  /* particles left the space in which they may be */
    CALCINE_FAILURE_MEMORY = 5,          /* too little memory */
    CALCINE_FAILURE_NOT_FINITE = 6,      /* a value is not finite */
    CALCINE_FAILURE_FILE = 7,            /* a file cannot be read or written */
    CALCINE_FAILURE_UNSUPPORTED = 8      /* a request or a column that this solver does not serve */
} calcine_failure;

/* Messages: who sends them, with what, when.
 *
 * HELLO        solver, then coordinator: text; calcine_link_handshake sends and reads it; first.
 * STATE        solver: columns "state"; once: a gas after OWNED, particles after the handshake. Heat, drag, impulse,
 *     balances and convergence are 0.
 * START        coordinator: columns "start"; the header has window, attempt and clocks; asks for one attempt at a
 *     window, always from the last commit. A gas gets several in a window, particles one. Answer: FINISHED.
 * FINISHED     solver: columns "state": the state at the end of the window, and what the attempt took; answers START.
 * COMMIT       coordinator: nothing; makes the last attempt the start of the next. Answer: COMMITTED where the link
 *     has columns "committed"; else none, and the next request may follow at once.
 * CHECKPOINT   coordinator: text: an existing folder, absolute; after a commit: write what is committed into the
 *     folder, to last, and go on from what was written. Answer: CHECKPOINTED.
 * CHECKPOINTED solver: columns "state", as with STATE; answers CHECKPOINT.
 * FAILED       either: text; the header's count is a calcine_failure. calcine_link_failed sends it; in place of any
 *     answer; the sender then ends.
 * BYE          coordinator, then solver: nothing; the run ends. Answer: BYE; then close the link and exit with 0.
 * OWNED        a gas: columns "owned"; once, after the handshake.
 * CHANGE       coordinator, to particles: text, one line each: "rest" (all come to rest where they are), "remove ID",
 *     "insert ID TYPE X Y Z VX VY VZ RADIUS DENSITY" (TYPE: population from 1; behind it WEIGHT where the link has
 *     weights), "resize ID RADIUS MASS"; between a commit and the next START. Answer: CHANGED.
 * CHANGED      particles: columns "state", as with STATE; answers CHANGE.
 * BOUNDARY     coordinator, to a gas, then the gas: text, one line each: "PATCH CONDITION VALUE...", the conditions
 *     as in the case file (superficial_velocity, mass_flow, temperature, composition, pressure, heat_flux,
 *     heat_transfer_coefficient, ambient), in SI; nothing back; between a commit and the next START, from which on it
 *     holds; after a resume it comes again. Answer: BOUNDARY, or FAILED with CALCINE_FAILURE_UNSUPPORTED.
 * COMMITTED    a gas with columns "committed": these columns; answers COMMIT.
 */

/* Columns of the role "gas": name, numbers a cell [unit], what it holds.
 *
 * "owned", with OWNED:
 *   cell 1 [u64]: numbers in the whole mesh of this rank's cells, in the order of all other columns.
 *   centre 3 [m]: centres of the cells; the coordinator compares them with its own. Where `mesh_hash` is NULL.
 *   volume 1 [m^3]: volumes of the cells; the coordinator compares them with its own. Where `mesh_hash` is NULL.
 *
 * "start", with START:
 *   void_fraction 1 [1]: void fraction eps at the end of the window, above 0 and at most 1.
 *   drag_coefficient 1 [kg/s]: D: the drag on the gas of the cell is drag_source - D u, with u at the end of the
 *     window.
 *   drag_source 3 [N]: explicit part of the drag on the gas of the cell.
 *   heat_coefficient 1 [W/K]: K: the heat to the gas of the cell is heat_source - K T, with T at the end of the
 *     window.
 *   heat_source 1 [W]: explicit part of the heat to the gas of the cell.
 *   species_source N [kg/s]: S: mass of a species to the gas of the cell is S - C Y, with Y at the end of the window.
 *     Of a gas of N species.
 *   species_coefficient N [kg/s]: C, 0 or more; the last species has none. Of a gas of N species.
 *   species_taken N [kg/s]: mass of a species that leaves with the gas' own temperature. Of a gas of N species.
 *   species_heat 1 [W]: sensible enthalpy that comes with species: species_heat less the sum of species_taken times
 *     h(T). Of a gas of N species.
 *   eddy_energy 1 [m^2/s^3]: a: the particles of the cell add a + b k to the production of k, per mass of gas; 0
 *     outside the bed. Of a gas whose eddies go on in the bed.
 *   eddy_dissipation 1 [m^2/s^4]: e: the particles of the cell add e + C2 b epsilon to the production of epsilon, per
 *     mass of gas. Of a gas whose eddies go on in the bed.
 *   eddy_growth 1 [1/s]: b. Of a gas whose eddies go on in the bed.
 *
 * "state", with STATE, FINISHED, CHECKPOINTED, CHANGED:
 *   heat 1 [W]: heat to the gas of the cell as the enthalpy equation took it, that of exchanged species included.
 *   drag 3 [N]: drag on the gas of the cell as the momentum equation took it.
 *   temperature 1 [K]: temperature.
 *   pressure 1 [Pa]: absolute pressure, hydrostatic part included.
 *   density 1 [kg/m^3]: density of the gas itself, not times eps.
 *   velocity 3 [m/s]: interstitial velocity; before the first window, when nothing is known of the bed, superficial.
 *   pressure_gradient 3 [Pa/m]: gradient of the pressure as the momentum equation has it.
 *   balances 7 (5 + N) [kg,J,Ns], once a rank: of all ranks: mass, enthalpy, momentum along x, y, z, then each
 *     species; each as stored, stored_magnitude, boundary, boundary_magnitude, exchange, source, source_magnitude.
 *   storage_clock 3 [Ns], once a rank: of all ranks: what momentum, which moves on the motion clock, gets because
 *     mass is stored over another span: the sum of u (1 - span_motion/storage_span) times the gas mass gained; a part
 *     of the momentum's sources.
 *   convergence 5 [1], once a rank: outer_iterations, linear_iterations, residual, volume_residual (largest mismatch
 *     of the mass with the equation of state, relative), converged (1 or 0).
 *   composition N [1]: mass fractions, species by species within each cell. Of a gas of N species.
 *   backflow 3 [1,m/s,1], once a rank: gas that comes in through outlets in the state of the cell behind: faces of
 *     the rank with it, the largest superficial velocity inwards, the number of the cell there in the whole mesh; 0 0
 *     0 where there is none. Of a gas whose catalogue has it.
 *   patch_flows (5 + N) a patch [W,kg/s,N,kg/s], once a rank: of all ranks, patch by patch in the order of the mesh,
 *     means over the window and + into the gas: heat (sensible enthalpy from 298.15 K on, with conduction), mass,
 *     momentum along x, y, z without pressure, then each species. Of a gas whose catalogue has it.
 *   turbulent_energy 1 [m^2/s^2]: k. Of a turbulent gas.
 *   dissipation 1 [m^2/s^3]: epsilon. Of a turbulent gas.
 *   eddy_viscosity 1 [Pas]: void fraction times eddy viscosity; 0 in a bed at which eddies end. Of a turbulent gas.
 *
 * "committed", with COMMITTED:
 *   turbulence_residual 1 [1], once a rank: largest relative residual of an equation of turbulence that its linear
 *     solver left above its tolerance; 0 where it left none. Of a gas that answers COMMIT.
 */

/* Columns of the role "particles": name, numbers a particle [unit], what it holds.
 *
 * "start", with START:
 *   id 1 [u64]: ids of the particles that the rank sent last, in its order.
 *   force 3 [N]: force of the gas; its impulse over the window is force times span_motion, whatever the steps.
 *   drag_coefficient 1 [kg/s]: K: beside the force a drag K (gas_velocity - v) acts, with the velocity v of the
 *     particle as it moves; its impulse over the window is that of K over span_motion, whatever the steps; 0 where
 *     drag is in the force. Where drag is pushed as a coefficient.
 *   gas_velocity 3 [m/s]: velocity of the gas at the particle, in motion time. Where drag is pushed as a coefficient.
 *
 * "state", with STATE, FINISHED, CHECKPOINTED, CHANGED:
 *   id 1 [u64]: ids, ascending, never used twice.
 *   population 1 [u64]: index of the population in the case file, from 0.
 *   position 3 [m]: centre.
 *   velocity 3 [m/s]: velocity, in motion time.
 *   angular_velocity 3 [rad/s]: angular velocity, in motion time.
 *   radius 1 [m]: radius.
 *   mass 1 [kg]: mass.
 *   weight 1 [1]: statistical weight: how many real particles the row stands for; force, impulse and mass are of one
 *     of them. Where rows may stand for several particles.
 *   impulse 3 [Ns]: impulse that what was pushed gave the particle; of one that is held, what its support took up.
 *   support 4 [s,Ns], once a rank: motion time that the steps of the window cover; impulse x, y, z that walls and
 *     held particles gave this rank's free ones, NaN where it is not counted.
 *   drag_impulse 3 [Ns]: impulse of that drag, a part of the column impulse; of a particle that is held K
 *     gas_velocity span_motion. Where drag is pushed as a coefficient.
 */

/* End of the generated part. */

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
    uint64_t count;        /* cells or particles in the columns; with CALCINE_FAILED a calcine_failure */
    uint64_t bytes;        /* bytes of the payload: columns, or text */
} calcine_header;

/* What a solver says of itself in the handshake. Texts end with a zero byte. The coordinator refuses a solver that
 * says something else than it expects, but for name and version. */
typedef struct calcine_hello {
    const char *role;      /* "gas" or "particles" */
    const char *name;      /* for example "OpenFOAM" */
    const char *version;   /* of the solver */
    const char *case_hash; /* of the case that Calcine wrote the inputs for; NULL where it wrote none */
    const char *mesh_hash; /* of the mesh (gas) or of the initial particles; NULL: not compared. A gas then says
                            * where its cells are (columns "centre" and "volume") */
    const char *origin;    /* the checkpoint that the state is from, as the variable CALCINE_RESUME or
                            * CALCINE_FROM has it; NULL: the solver starts anew */
    const char *catalogue; /* NULL: the columns of the role that all links have, and those of a NULL mesh_hash;
                            * else all columns, one a line: "start|state|owned NAME NUMBERS UNIT item|rank", or
                            * "standard" for those that all links of the role have, and for particles "moving_drag",
                            * "weights" for those that a link may have: "standard\nmoving_drag" */
    uint64_t count;        /* cells or particles of all ranks */
    uint32_t ranks;        /* ranks of the solver */
} calcine_hello;

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

/* Opens the link of a rank, as the variable CALCINE_LINK describes it; `carrier` may be NULL where none is needed.
 * A header of another version than the library's is refused. */
calcine_status calcine_link_open_version(uint32_t header_version, uint32_t rank, const calcine_carrier *carrier,
                                         calcine_link **link);

static inline calcine_status calcine_link_open(uint32_t rank, const calcine_carrier *carrier, calcine_link **link) {
    return calcine_link_open_version(CALCINE_WIRE_VERSION, rank, carrier, link);
}

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

/* Tells the coordinator that the solver failed: of which kind, and in one sentence what, with number, unit and
 * place; a particle by its id. Then close and exit. */
calcine_status calcine_link_failed(calcine_link *link, calcine_failure failure, const char *text);

/* What went wrong in this thread's last call that did not return CALCINE_OK; never NULL. */
const char *calcine_last_error(void);

/* Closes the link; NULL is allowed. */
void calcine_link_close(calcine_link *link);

#ifdef __cplusplus
}
#endif

#endif
