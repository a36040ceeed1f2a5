/*
 * A robot's control loop: wave, move, player, motors; what its sensors find, the map learns.
 *
 *   cc -std=c99 -O2 -Iinclude examples/robot.c src/ac_*.c -o robot && ./robot
 *
 * Replace the simulated robot by functions that read your encoders and sensors and write your motors. It
 * meets an obstacle that the map does not know, and the program returns 1 if it does not get past it.
 */
#include "activecell.h"

#include <stdio.h>

/* The map that the robot learns, in RAM; the wave on it. */
static uint32_t rows[AC_FLOOR_MAP_WORDS];
static uint32_t memory[AC_FLOOR_WAVE_WORDS];
static ac_map map;

/* ---- A simulated robot ---- */

static struct {
    ac_cell cell;       /* Where it stands, or came from. */
    ac_cell surprise;   /* An obstacle that is not on the map. */
    uint32_t motors;    /* What was written last. */
    bool is_between;    /* Between two ticks. */
    uint32_t rolled;    /* Ticks forwards since the start, */
    uint32_t turned;    /* and those of turns, to the right; negative ones wrap around. */
    uint32_t moves;     /* Cells that it has come. */
    uint32_t met;       /* Obstacles that it has found. */
    ac_move heading_at; /* Where it faced at the start. */
} robot;

static void write_motors(uint32_t outputs)
{
    robot.motors = outputs;
}

/*
 * Ticks since the last call: an interrupt counts them on a real robot. Here one comes at every second
 * call, for a loop should be faster than its ticks.
 */
static uint32_t read_ticks(void)
{
    uint32_t ticks = 1U;
    robot.is_between = !robot.is_between;
    if (robot.is_between) {
        ticks = 0U;
    } else if (robot.motors == AC_OUT_DRIVE) {
        ++robot.rolled;
    } else if (robot.motors == (AC_OUT_DRIVE | AC_OUT_RIGHT)) {
        ++robot.turned;
    } else if (robot.motors == (AC_OUT_DRIVE | AC_OUT_LEFT)) {
        --robot.turned;
    } else {
        ticks = 0U;
    }
    return ticks;
}

/* What stands in the way right now, say a person: AC_IN_FRONT and the like. Nobody walks here. */
static uint32_t read_obstacles(void)
{
    return 0U;
}

/* Whether a distance sensor finds the cell in a direction occupied. */
static bool sees_obstacle(ac_move direction)
{
    const ac_cell cell = ac_neighbour(robot.cell, direction);
    return (cell.x == robot.surprise.x) && (cell.y == robot.surprise.y);
}

/* A number of ticks in cells or turns, rounded. */
static uint32_t in_steps(uint32_t ticks, uint32_t ticks_256)
{
    return (uint32_t)((((uint64_t)ticks * 256U) + (ticks_256 / 2U)) / ticks_256);
}

/* Where the ticks have brought it: false if they are not those of one cell more. */
static bool has_come(void)
{
    const bool is_left = (robot.turned >> 31U) != 0U;
    const uint32_t turns = in_steps(is_left ? (0U - robot.turned) : robot.turned, AC_TURN_TICKS_256);
    const uint32_t steps = turns % AC_DIRECTIONS;
    const uint32_t right = is_left ? (AC_DIRECTIONS - steps) : steps;
    ++robot.moves;
    robot.cell = ac_neighbour(robot.cell, (robot.heading_at + right) % AC_DIRECTIONS);
    return in_steps(robot.rolled, AC_CELL_TICKS_256) == robot.moves;
}

/* ---- The control loop ---- */

/* Ways from all cells to the target, over the map as it is known now. */
static bool plan(ac_wave *wave, ac_cell target)
{
    const bool is_planned = ac_wave_start(wave, &map, target, memory, AC_FLOOR_WAVE_WORDS);
    if (is_planned) {
        ac_wave_flood(wave);
    }
    return is_planned;
}

/* Drives to a neighbour. On a real robot a timer calls ac_player_advance, some hundred times a second. */
static void drive(ac_course *course, ac_move move)
{
    ac_segment segments[2];
    ac_player player;
    ac_player_start(&player, segments, ac_course_move(course, segments, move));
    while (!ac_player_is_done(&player)) {
        write_motors(ac_player_advance(&player, true, read_ticks(), read_obstacles()));
    }
}

/* Drives to the target: AC_ARRIVED, AC_UNREACHABLE, or AC_OUTSIDE. */
static ac_move travel(ac_cell from, ac_move heading, ac_cell target)
{
    ac_cell cell = from;
    ac_move move = AC_UNREACHABLE;
    ac_course course;
    ac_wave wave;
    ac_course_start(&course, heading);
    if (plan(&wave, target)) {
        move = ac_wave_next(&wave, cell);
    }
    while (move < AC_DIRECTIONS) {
        if (sees_obstacle(move)) {
            ++robot.met;
            (void)ac_map_set(rows, &map, ac_neighbour(cell, move), true);
            move = plan(&wave, target) ? ac_wave_next(&wave, cell) : AC_UNREACHABLE;
        } else {
            drive(&course, move);
            cell = ac_neighbour(cell, move);
            move = has_come() ? ac_wave_next(&wave, cell) : AC_OUTSIDE;
        }
    }
    return move;
}

/* ---- A surprise for it ---- */

/* The first cell of the way without which there is still another way; the target if there is none. */
static ac_cell on_the_way(ac_cell from, ac_cell target)
{
    ac_cell surprise = target;
    ac_cell cell = from;
    bool is_found = false;
    ac_wave wave;
    while (!is_found && plan(&wave, target) && (ac_wave_next(&wave, cell) < AC_DIRECTIONS)) {
        cell = ac_neighbour(cell, ac_wave_next(&wave, cell));
        (void)ac_map_set(rows, &map, cell, true);
        if (plan(&wave, target) && (ac_wave_next(&wave, from) < AC_DIRECTIONS)) {
            surprise = cell;
            is_found = true;
        }
        (void)ac_map_set(rows, &map, cell, false);
    }
    return surprise;
}

int main(void)
{
    const ac_cell from = { AC_PROGRAM_FROM_X, AC_PROGRAM_FROM_Y };
    const ac_cell target = { AC_PROGRAM_TO_X, AC_PROGRAM_TO_Y };
    ac_move end = AC_UNREACHABLE;
    uint32_t word;
    if ((AC_CELL_TICKS_256 < 512U) || ((AC_TURN_TICKS_256 < 512U) && (AC_TURN_TICKS_256 != 256U))) {
        printf("robot: NOT RUN, its encoder is too coarse to drive from cell to cell\n");
        return 0;
    }
    for (word = 0U; word < AC_FLOOR_MAP_WORDS; ++word) {
        rows[word] = ac_floor.rows[word];
    }
    map = ac_floor;
    map.rows = rows;
    robot.surprise = on_the_way(from, target);
    if ((robot.surprise.x == target.x) && (robot.surprise.y == target.y)) {
        /* There is one way only: nothing stands in it. */
        robot.surprise.x = UINT16_MAX;
    }
    robot.cell = from;
    robot.heading_at = AC_PROGRAM_HEADING;
    end = travel(from, AC_PROGRAM_HEADING, target);
    printf("%s after %lu cells, %lu ticks forwards; obstacles that were not on the map: %lu\n",
           (end == AC_ARRIVED) ? "PASS: the robot arrived" : "FAIL: the robot did not arrive",
           (unsigned long)robot.moves, (unsigned long)robot.rolled, (unsigned long)robot.met);
    return ((end == AC_ARRIVED) && (robot.cell.x == target.x) && (robot.cell.y == target.y)) ? 0 : 1;
}
