/*
 * The control unit of the motors, the player of programs, and segments for moves from cell to cell.
 */
#include "activecell.h"
#include "ac_bit.h"

@CONTROL_FUNCTION@
@PLAYER_FUNCTION@
uint32_t ac_control_step(uint32_t state, uint32_t inputs)
{
    return ac_control_next(state, inputs).next_state;
}

uint32_t ac_control_outputs(uint32_t state)
{
    const ac_control_next_outputs outputs = ac_control_next(state, 0U);
    return outputs.q0 | (outputs.q1 << 1U) | (outputs.q2 << 2U) | (outputs.q3 << 3U);
}

void ac_player_start(ac_player *player, const ac_segment *segments, uint32_t count)
{
    player->segments = segments;
    player->count = count;
    player->segment = 0U;
    player->ticks = 0U;
    player->state = AC_CALM;
}

/* Whether all ticks have come; the motors may still be on. */
static bool has_ended(const ac_player *player)
{
    return player->segment >= player->count;
}

bool ac_player_is_done(const ac_player *player)
{
    const bool rests = (player->state == AC_CALM) || (player->state == AC_STOPPED);
    return rests && has_ended(player);
}

/* What the control unit is told for the segment that the player is in. */
static uint32_t inputs_of(const ac_player *player, bool go, uint32_t obstacles)
{
    const bool is_done = has_ended(player);
    const bool may_go = go && ((obstacles & AC_IN_STOP) == 0U);
    uint32_t motion = 0U;
    if (!is_done) {
        motion = player->segments[player->segment].motion;
    }
    return ac_player_inputs(motion, ac_bit(is_done), ac_bit(may_go), (obstacles >> 2U) & 0x0FU);
}

uint32_t ac_player_clock(ac_player *player, bool go, bool tick, uint32_t obstacles)
{
    player->state = ac_control_step(player->state, inputs_of(player, go, obstacles));
    if (tick && !has_ended(player)) {
        player->ticks += 1U;
        if (player->ticks >= player->segments[player->segment].ticks) {
            player->segment += 1U;
            player->ticks = 0U;
        }
    }
    return ac_control_outputs(player->state);
}

uint32_t ac_player_advance(ac_player *player, bool go, uint32_t ticks, uint32_t obstacles)
{
    uint32_t outputs = ac_player_clock(player, go, ticks > 0U, obstacles);
    uint32_t tick;
    for (tick = 1U; tick < ticks; ++tick) {
        outputs = ac_player_clock(player, go, true, obstacles);
    }
    return outputs;
}

/* Half a part short of the next tick: what is left out is rounded, not cut off. */
#define HALF_A_TICK 128U

void ac_course_start(ac_course *course, ac_move heading)
{
    course->heading = heading;
    course->run = HALF_A_TICK;
    course->turn = HALF_A_TICK;
}

/* Turns by steps clockwise, up to half way round, else anticlockwise: left of the heading. */
static ac_segment turn_of(ac_course *course, uint32_t clockwise)
{
    ac_segment segment = { AC_RUN_RIGHT, 0U };
    if (clockwise <= (AC_DIRECTIONS / 2U)) {
        course->turn += clockwise * AC_TURN_TICKS_256;
        segment.ticks = course->turn >> 8U;
        course->turn &= 0xFFU;
    } else {
        /* What is owed grows by what the turn takes less than its ticks, which are rounded up. */
        const uint32_t parts = (AC_DIRECTIONS - clockwise) * AC_TURN_TICKS_256;
        segment.motion = AC_RUN_LEFT;
        segment.ticks = ((parts + 0xFFU) - course->turn) >> 8U;
        course->turn = (course->turn + (segment.ticks << 8U)) - parts;
    }
    return segment;
}

uint32_t ac_course_move(ac_course *course, ac_segment *segments, ac_move move)
{
    uint32_t count = 0U;
    if (move < AC_DIRECTIONS) {
        const uint32_t round = (move + AC_DIRECTIONS) - course->heading;
        const uint32_t clockwise = (round < AC_DIRECTIONS) ? round : (round - AC_DIRECTIONS);
        const ac_segment turn = turn_of(course, clockwise);
        ac_segment run = { AC_RUN_FORWARD, 0U };
        course->heading = move;
        course->run += AC_CELL_TICKS_256;
        run.ticks = course->run >> 8U;
        course->run &= 0xFFU;
        if (turn.ticks > 0U) {
            segments[count] = turn;
            count += 1U;
        }
        if (run.ticks > 0U) {
            segments[count] = run;
            count += 1U;
        }
    }
    return count;
}
