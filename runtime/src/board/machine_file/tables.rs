//! The tables of a machine file, and the effects of their keys.

use kmotiondef::{AxisId, Bit};
use toml::de::DeTable;

use super::read::{ReadResult, Source, Table, TextError, Value, keys};
use super::{
    Analog, AnalogSource, Axis, Channel, Condition, Encoder, Gantry, Handwheel, Index, MachineFile,
    MachineFileError, Model, Probe, Spindle, SpindleDrive, Spring, Switch, Travel, Wire,
};
use super::{boards, events, pc};
use crate::io::kanalog::COUNTS_PER_VOLT;
use crate::machine::wiring::Wiring;
use crate::out::REMARKS;

/// Applies the settings of a text to a machine.
/// Of a text that is an option, places have no line.
pub(super) fn apply(machine: &mut MachineFile, text: &str, is_option: bool) -> Result<(), MachineFileError> {
    let table = DeTable::parse(text).map_err(|error| {
        let offset = error.span().map_or(0, |span| span.start);
        TextError::new(offset, error.message()).in_text(text)
    })?;
    let mut statements = Vec::new();
    let from = Source { text: (!is_option).then_some(text), board: machine.board };
    let root = read_root(machine, &mut statements, &Table::new("", 0, table.get_ref(), from));
    root.map_err(|wrong| wrong.in_text(text))?;
    machine.stimulus.rules.extend(events::rules(statements, text)?);
    Ok(())
}

fn read_root(
    machine: &mut MachineFile,
    statements: &mut Vec<(usize, String)>,
    table: &Table<'_>,
) -> ReadResult<()> {
    keys!(table, |key, value| {
        "axis" => axes(machine, &value.indexed_tables()?)?;
        "switch" => machine.connected.switches.extend(read_each(&value, switch)?);
        "probe" => machine.connected.probes.extend(read_each(&value, probe)?);
        "encoder" => handwheels(&mut machine.connected.encoders, &value)?;
        "adc" => machine.connected.analog.extend(read_each(&value, analog)?);
        "wire" => machine.wires.extend(read_each(&value, wire)?);
        "event" => statements.extend(events::events(&value)?);
        "device" => statements.extend(events::devices(&value)?);
        "gantry" => machine.connected.gantries.extend(read_each(&value, gantry)?);
        "spindle" => spindles(&mut machine.connected.spindles, &value)?;
        "inputs" => inputs(machine, &value.table()?)?;
        "remarks" => remarks(machine, &value.table()?)?;
        "cpu" => cpu(machine, &value.table()?)?;
        "host" => pc::host(machine, &value.table()?)?;
        "board" => boards::board(machine, &value.table()?)?;
        "uart" => boards::uart(machine, &value.table()?)?;
    });
    Ok(())
}

/// `CODE = false` switches a remark off.
fn remarks(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    for (key, value) in table.entries() {
        let is_wanted = value.flag()?;
        if machine.want_remark(key.text, is_wanted).is_none() {
            let codes: Vec<_> = REMARKS.iter().map(|row| row.code).collect();
            return Err(key.is_unknown(&codes));
        }
    }
    Ok(())
}

fn read_each<T>(value: &Value<'_>, read: impl Fn(&Table<'_>) -> ReadResult<T>) -> ReadResult<Vec<T>> {
    value.tables()?.iter().map(read).collect()
}

fn axes(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    for (key, value) in table.entries() {
        let (number, table) = (key.axis()?, value.table()?);
        axis(&mut machine.axes[number.index()], &table)?;
        one_encoder(machine, number, &table)?;
    }
    Ok(())
}

/// Refuses a second encoder on an input.
fn one_encoder(machine: &MachineFile, axis: AxisId, table: &Table<'_>) -> ReadResult<()> {
    let wiring = Wiring::new(&machine.axes);
    let Some(input) = wiring.input(axis) else { return Ok(()) };
    let Some(other) = AxisId::all().find(|other| *other != axis && wiring.input(*other) == Some(input))
    else {
        return Ok(());
    };
    let text = format!(
        "`{}`: encoder input {input} has the encoder of axis {other} already (that of a motor is on the input of its \
         number, unless `encoder = {{ input = N }}` says otherwise)",
        table.name
    );
    Err(TextError::new(table.offset, text))
}

fn axis(axis: &mut Axis, table: &Table<'_>) -> ReadResult<()> {
    axis.keys.extend(table.entries().map(|(key, _)| (key.text.to_owned(), key.place())));
    keys!(table, |key, value| {
        "name" => value.text()?.clone_into(&mut axis.name);
        "model" => axis.model = value.choice(Model::NAMED)?;
        "units" => value.text()?.clone_into(&mut axis.units);
        "counts_per_unit" => axis.counts_per_unit = not_zero(&value)?;
        "encoder" => match value.table() {
            Ok(table) => axis.connection.input = Some(encoder_input(&table)?),
            Err(_) => {
                let choices =
                    [("auto", Encoder::Auto), ("true", Encoder::Connected), ("false", Encoder::Absent)];
                axis.connection.encoder = value.choice(&choices)?;
            }
        };
        "drive" => axis.connection.drive = Some(channel(&value.table()?)?);
        "lag_s" => axis.lag_s = value.not_negative()?;
        "min" => axis.travel.min = value.number()?;
        "max" => axis.travel.max = value.number()?;
        "start" => axis.travel.start = value.number()?;
        "backlash" => axis.travel.backlash = value.not_negative()?;
        "spring" => axis.travel.spring = Some(spring(&value.table()?)?);
        "ku" => axis.motor.ku = Some(value.number()?);
        "tau_s" => axis.motor.tau_s = value.positive()?;
        "friction" => axis.motor.friction = value.not_negative()?;
        "ka" => axis.motor.ka = value.number()?;
        "tau_v_s" => axis.motor.tau_v_s = value.positive()?;
        "inertia" => axis.motor.inertia = value.positive()?;
        "pull" => axis.motor.pull = value.number()?;
        "cycles_per_unit" => axis.rotor.cycles_per_unit = Some(not_zero(&value)?);
        "rotor_phase" => axis.rotor.phase = value.number()?;
        "index" => axis.index = Some(index(&value.table()?)?);
    });
    let Travel { min, max, .. } = axis.travel;
    if min > max {
        let text = format!("`{}`: min {min} exceeds max {max}", table.name);
        return Err(TextError::new(table.offset, text));
    }
    Ok(())
}

/// `{ hz = 20, damping = 0.05 }`
fn spring(table: &Table<'_>) -> ReadResult<Spring> {
    const FASTEST: f64 = 500.0;
    let (mut hz, mut damping) = (None, 0.05);
    keys!(table, |key, value| {
        "hz" => hz = Some(value.positive()?.min(FASTEST));
        "damping" => damping = value.not_negative()?;
    });
    Ok(Spring { hz: hz.ok_or_else(|| table.is_missing("hz"))?, damping })
}

/// `axes = [0, 1]` and `most`.
fn gantry(table: &Table<'_>) -> ReadResult<Gantry> {
    let (mut axes, mut most) = (Vec::new(), 100.0);
    keys!(table, |key, value| {
        "axes" => {
            for item in value.array()? {
                axes.push(item.axis()?);
            }
        };
        "most" => most = value.positive()?;
    });
    match axes[..] {
        [a, b] if a != b => Ok(Gantry { axes: [a, b], most }),
        _ => Err(TextError::new(table.offset, format!("`{}`: `axes` must name two axes", table.name))),
    }
}

/// `{ input = 0 }`
fn encoder_input(table: &Table<'_>) -> ReadResult<usize> {
    let mut input = None;
    keys!(table, |key, value| {
        "input" => input = Some(value.unsigned(15)? as usize);
    });
    input.ok_or_else(|| table.is_missing("input"))
}

/// `{ dac = 0 }`, `{ step = 8 }`, `{ pwm = 8 }` or `{ pwm = 0, amplifier = "snapamp" }` with the numbers of `OutputChan0`,
/// or `{ forward = 152, back = 153 }`.
fn channel(table: &Table<'_>) -> ReadResult<Channel> {
    /// The number of PWM channels before those of the SnapAmps.
    const ON_BOARD: usize = 8;
    let (mut channel, mut is_snapamp) = (None, false);
    let (mut forward, mut back) = (None, None);
    keys!(table, |key, value| {
        "dac" => channel = Some(Channel::Dac(value.unsigned(7)? as usize));
        "step" => channel = Some(Channel::Generator(value.unsigned(31)? as usize & 7));
        "pwm" => channel = Some(Channel::Pwm(value.unsigned(15)? as usize));
        "forward" => forward = Some(value.output()?);
        "back" => back = Some(value.output()?);
        "amplifier" => is_snapamp = value.choice(&[("snapamp", true)])?;
    });
    let relays = forward.zip(back).map(|(forward, back)| Channel::Relays(forward, back));
    match channel.or(relays) {
        Some(Channel::Pwm(number)) if is_snapamp && number < ON_BOARD => Ok(Channel::Pwm(ON_BOARD + number)),
        Some(channel) => Ok(channel),
        None => Err(table.is_missing("dac")),
    }
}

fn not_zero(value: &Value<'_>) -> ReadResult<f64> {
    let number = value.number()?;
    if number == 0.0 { Err(value.is_wrong("a number other than 0")) } else { Ok(number) }
}

fn index(table: &Table<'_>) -> ReadResult<Index> {
    let (mut bit, mut every, mut width, mut offset) = (None, None, 1.0, 0.0);
    keys!(table, |key, value| {
        "bit" => bit = Some(value.input()?);
        "every" => every = Some(value.positive()?);
        "width" => width = value.positive()?;
        "offset" => offset = value.number()?;
    });
    let bit = bit.ok_or_else(|| table.is_missing("bit"))?;
    Ok(Index { bit, every: every.ok_or_else(|| table.is_missing("every"))?, width, offset })
}

fn switch(table: &Table<'_>) -> ReadResult<Switch> {
    let (mut bit, mut axis, mut when, mut active) = (None, None, None, true);
    keys!(table, |key, value| {
        "bit" => bit = Some(value.input()?);
        "axis" => axis = Some(value.axis()?);
        "when" => when = Some(condition(&value)?);
        "active" => active = value.flag()?;
    });
    Ok(Switch {
        bit: bit.ok_or_else(|| table.is_missing("bit"))?,
        axis: axis.ok_or_else(|| table.is_missing("axis"))?,
        when: when.ok_or_else(|| table.is_missing("when"))?,
        active,
        place: table.place(),
    })
}

/// `<= -1000`, `>= 5`, `between 3 7`.
fn condition(value: &Value<'_>) -> ReadResult<Condition> {
    let wrong = || value.is_wrong("\"<= X\", \">= X\" or \"between X Y\"");
    let text = value.text()?.trim();
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    if let Some(rest) = text.strip_prefix("<=") {
        return number(rest).map(Condition::AtMost).ok_or_else(wrong);
    }
    if let Some(rest) = text.strip_prefix(">=") {
        return number(rest).map(Condition::AtLeast).ok_or_else(wrong);
    }
    let ends: Option<Vec<f64>> =
        text.strip_prefix("between").map(|rest| rest.split_whitespace().filter_map(number).collect());
    match ends.as_deref() {
        Some(&[from, to]) if from <= to => Ok(Condition::Between(from, to)),
        _ => Err(wrong()),
    }
}

fn probe(table: &Table<'_>) -> ReadResult<Probe> {
    let (mut bit, mut surface, mut above) = (None, None, false);
    keys!(table, |key, value| {
        "bit" => bit = Some(value.input()?);
        "surface" => surface = Some(place(&value.table()?)?);
        "trips" => above = value.choice(&[("<=", false), (">=", true)])?;
    });
    let (axis, at) = surface.ok_or_else(|| table.is_missing("surface"))?;
    let touches = if above { Condition::AtLeast(at) } else { Condition::AtMost(at) };
    Ok(Probe { bit: bit.ok_or_else(|| table.is_missing("bit"))?, axis, touches, place: table.place() })
}

fn place(table: &Table<'_>) -> ReadResult<(AxisId, f64)> {
    let (mut axis, mut at) = (None, None);
    keys!(table, |key, value| {
        "axis" => axis = Some(value.axis()?);
        "at" => at = Some(value.number()?);
    });
    Ok((axis.ok_or_else(|| table.is_missing("axis"))?, at.ok_or_else(|| table.is_missing("at"))?))
}

fn handwheels(wheels: &mut Vec<Handwheel>, value: &Value<'_>) -> ReadResult<()> {
    for wheel in read_each(value, handwheel)? {
        if wheels.iter().any(|other| other.channel == wheel.channel) {
            let text = format!(
                "`encoder`: channel {} has two tables; one of them has all its `moves`",
                wheel.channel
            );
            return Err(TextError::new(value.offset(), text));
        }
        wheels.push(wheel);
    }
    Ok(())
}

fn handwheel(table: &Table<'_>) -> ReadResult<Handwheel> {
    let (mut channel, mut moves) = (None, Vec::new());
    keys!(table, |key, value| {
        "channel" => channel = Some(value.unsigned(15)? as usize);
        "moves" => moves = value.array()?.iter().map(read_turn).collect::<ReadResult<_>>()?;
    });
    Ok(Handwheel { channel: channel.ok_or_else(|| table.is_missing("channel"))?, moves })
}

/// Start in seconds, counts, duration in seconds.
fn read_turn(value: &Value<'_>) -> ReadResult<[f64; 3]> {
    let parts = value.array()?;
    let [start, counts, duration] = parts.as_slice() else {
        return Err(value.is_wrong("[start in seconds, counts, duration in seconds]"));
    };
    Ok([start.not_negative()?, counts.number()?, duration.not_negative()?])
}

fn analog(table: &Table<'_>) -> ReadResult<Analog> {
    let (mut channel, mut source) = (None, None);
    keys!(table, |key, value| {
        "channel" => channel = Some(value.unsigned(7)? as usize);
        "value" => source = Some(AnalogSource::Value(counts(&value)?));
        "sine" => source = Some(sine(&value.table()?)?);
        "follows" => source = Some(read_follower(&value.table()?)?);
    });
    let source = source.ok_or_else(|| table.is_missing("value"))?;
    Ok(Analog { channel: channel.ok_or_else(|| table.is_missing("channel"))?, source })
}

/// Counts of an analog input, or volts as a text: `"7.5V"`.
fn counts(value: &Value<'_>) -> ReadResult<f64> {
    let Ok(text) = value.text() else { return value.number() };
    let volts = text.strip_suffix('V').and_then(|volts| volts.trim().parse::<f64>().ok());
    let volts = volts.filter(|volts| volts.is_finite());
    volts
        .map(|volts| volts * COUNTS_PER_VOLT)
        .ok_or_else(|| value.is_wrong("counts, or volts such as \"7.5V\""))
}

fn sine(table: &Table<'_>) -> ReadResult<AnalogSource> {
    let (mut mean, mut amp, mut hz) = (0.0, 0.0, 1.0);
    keys!(table, |key, value| {
        "mean" => mean = value.number()?;
        "amp" => amp = value.number()?;
        "hz" => hz = value.not_negative()?;
    });
    Ok(AnalogSource::Sine { mean, amp, hz })
}

fn read_follower(table: &Table<'_>) -> ReadResult<AnalogSource> {
    let (mut axis, mut gain, mut offset) = (None, 1.0, 0.0);
    keys!(table, |key, value| {
        "axis" => axis = Some(value.axis()?);
        "gain" => gain = value.number()?;
        "offset" => offset = value.number()?;
    });
    Ok(AnalogSource::Follows { axis: axis.ok_or_else(|| table.is_missing("axis"))?, gain, offset })
}

fn wire(table: &Table<'_>) -> ReadResult<Wire> {
    let (mut from, mut to, mut invert, mut delay_s) = (None, None, false, 0.0);
    keys!(table, |key, value| {
        "from" => from = Some(value.output()?);
        "to" => to = Some(value.input()?);
        "invert" => invert = value.flag()?;
        "delay_s" => delay_s = value.not_negative()?;
    });
    Ok(Wire {
        from: from.ok_or_else(|| table.is_missing("from"))?,
        to: to.ok_or_else(|| table.is_missing("to"))?,
        invert,
        delay_s,
    })
}

/// `[spindle]`, which changes the first one, or `[[spindle]]`.
fn spindles(spindles: &mut Vec<Spindle>, value: &Value<'_>) -> ReadResult<()> {
    match value.table() {
        Ok(table) => {
            let changed = spindle(spindles.first().copied(), &table)?;
            spindles.splice(..spindles.len().min(1), [changed]);
        }
        Err(_) => spindles.extend(read_each(value, |table| spindle(None, table))?),
    }
    Ok(())
}

fn spindle(before: Option<Spindle>, table: &Table<'_>) -> ReadResult<Spindle> {
    let (mut axis, mut drive) = (before.map(|spindle| spindle.axis), before.map(|spindle| spindle.drive));
    let [mut counts, mut full, mut tau] = before.map_or([4096.0, 50.0, 0.5], |spindle| {
        [spindle.counts_per_rev, spindle.full_scale_rps, spindle.tau_s]
    });
    let [mut droop, mut load] = before.map_or([0.0, 0.0], |spindle| [spindle.droop_rps, spindle.load]);
    keys!(table, |key, value| {
        "axis" => axis = Some(value.axis()?);
        "counts_per_rev" => counts = not_zero(&value)?;
        "driven_by" => drive = Some(SpindleDrive::Axis(named_axis(&value)?));
        "dac" => drive = Some(SpindleDrive::Dac(value.unsigned(7)? as usize));
        "bits" => drive = Some(directions(&value.table()?)?);
        "full_scale_rps" => full = value.positive()?;
        "tau_s" => tau = value.positive()?;
        "droop_rps" => droop = value.not_negative()?;
        "load" => load = value.not_negative()?.min(1.0);
    });
    Ok(Spindle {
        axis: axis.ok_or_else(|| table.is_missing("axis"))?,
        counts_per_rev: counts,
        drive: drive.ok_or_else(|| table.is_missing("driven_by"))?,
        full_scale_rps: full,
        tau_s: tau,
        droop_rps: droop,
        load,
    })
}

/// `axis 7`.
fn named_axis(value: &Value<'_>) -> ReadResult<AxisId> {
    let number = value.text()?.strip_prefix("axis").and_then(|rest| rest.trim().parse().ok());
    let axes = value.board().axes;
    let wrong = || value.is_wrong(&format!("\"axis N\", 0 to {}", axes.last()));
    number.and_then(|number| axes.get(number)).ok_or_else(wrong)
}

fn directions(table: &Table<'_>) -> ReadResult<SpindleDrive> {
    let (mut cw, mut ccw) = (None, None);
    keys!(table, |key, value| {
        "cw" => cw = Some(value.output()?);
        "ccw" => ccw = Some(value.output()?);
    });
    Ok(SpindleDrive::Bits {
        cw: cw.ok_or_else(|| table.is_missing("cw"))?,
        ccw: ccw.ok_or_else(|| table.is_missing("ccw"))?,
    })
}

fn inputs(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    keys!(table, |key, value| {
        "idle_high" => {
            for item in value.array()? {
                machine.idle_high.extend(bits(&item)?);
            }
        };
        "hints" => machine.hints = value.flag()?;
    });
    Ok(())
}

/// A bit, or a range of them as a text: `140-143`.
fn bits(value: &Value<'_>) -> ReadResult<Vec<Bit>> {
    let Ok(text) = value.text() else { return Ok(vec![value.input()?]) };
    let ends = text
        .split_once('-')
        .and_then(|(from, to)| Some((from.trim().parse().ok()?, to.trim().parse().ok()?)));
    let (from, to): (i32, i32) =
        ends.ok_or_else(|| value.is_wrong("a bit or a range such as \"140-143\""))?;
    let range: Option<Vec<Bit>> = (from..=to.min(from.saturating_add(2047))).map(Bit::new).collect();
    range.filter(|bits| !bits.is_empty()).ok_or_else(|| value.is_wrong("a range of bits, 0 to 2047"))
}

fn cpu(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    keys!(table, |key, value| {
        "servo_us" => {
            let time = value.not_negative()?;
            if time >= 90.0 {
                return Err(value.is_wrong("below the 90 µs of a tick"));
            }
            machine.cpu.servo_us = Some(time);
        };
        "bss_fill" => machine.cpu.bss_fill = value.unsigned(255)? as u8;
        "strict_stack" => machine.cpu.strict_stack = value.flag()?;
        "ns_per_instruction" => {
            let time = value.positive()?;
            if !(0.1..=1000.0).contains(&time) {
                return Err(value.is_wrong("from 0.1 to 1000 nanoseconds"));
            }
            machine.cpu.ns_per_instruction = time;
        };
        "board_faults" => machine.cpu.board_faults = value.flag()?;
        "plan_ticks" => machine.cpu.plan_ticks = value.unsigned(100_000)?;
        "fresh_globals" => machine.cpu.fresh_globals = value.flag()?;
    });
    Ok(())
}
