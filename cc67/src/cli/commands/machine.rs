//! `cc67 machine`: computes keys of a machine file from the data sheets of motor, amplifier and encoder.

use anyhow::{Result, bail};
use clap::{Args, Subcommand};

use crate::cli::io::exit::Exit;
use crate::cli::io::output;

/// The counts of an analog output at 10 V, and the counts of a quadrature encoder per line.
const FULL_SCALE: f64 = 2047.0;
const FULL_VOLTS: f64 = 10.0;
const PER_LINE: f64 = 4.0;
const SECONDS: f64 = 60.0;

/// Arguments of `cc67 machine`.
#[derive(Debug, Args)]
pub(super) struct MachineArguments {
    #[command(subcommand)]
    rule: Rule,
}

/// The rules.
#[derive(Clone, Copy, Debug, Subcommand)]
enum Rule {
    /// A servo whose amplifier has a speed input: `VOLTS = RPM`, and an encoder with LINES
    Servo(Servo),
}

/// The data sheet of a servo.
#[derive(Clone, Copy, Debug, Args)]
struct Servo {
    /// Axis of the machine file
    #[arg(long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u8).range(0..8))]
    axis: u8,
    /// Input voltage of the amplifier
    #[arg(long, value_name = "V", default_value = "10")]
    volts: f64,
    /// Speed of the motor at that voltage, in revolutions per minute
    #[arg(long, value_name = "RPM")]
    rpm: f64,
    /// Lines of the encoder; it counts four times as many
    #[arg(long, value_name = "LINES")]
    lines: f64,
    /// Units of the axis per revolution of the motor; without it the unit is an encoder count
    #[arg(long, value_name = "UNITS")]
    units_per_rev: Option<f64>,
    /// Time constant of motor and amplifier in milliseconds: the time to 63 % of the speed
    #[arg(long, value_name = "MS", default_value = "20")]
    tau_ms: f64,
}

/// Prints the table of an axis.
pub(super) fn machine(arguments: &MachineArguments) -> Result<Exit> {
    let Rule::Servo(servo) = arguments.rule;
    output::print(&servo.table()?)?;
    Ok(Exit::Success)
}

impl Servo {
    fn table(&self) -> Result<String> {
        let Self { axis, volts, rpm, lines, units_per_rev, tau_ms } = *self;
        let numbers = [volts, rpm, lines, tau_ms, units_per_rev.unwrap_or(1.0)];
        if !numbers.iter().all(|number| number.is_finite() && *number > 0.0) {
            bail!("voltage, speed, lines, units and time constant must be numbers above 0");
        }
        let counts_per_rev = lines * PER_LINE;
        let units = units_per_rev.unwrap_or(counts_per_rev);
        let top = rpm / SECONDS * units;
        let ku = top / (volts / FULL_VOLTS * FULL_SCALE);
        Ok(format!(
            "# {rpm} rpm at {volts} V, {lines} lines: {top:.0} units/s\n\
             [axis.{axis}]\n\
             model = \"motor\"\n\
             ku = {ku:.3}\n\
             tau_s = {}\n\
             counts_per_unit = {}\n\
             encoder = {{ input = {axis} }}\n\
             drive = {{ dac = {axis} }}\n",
            tau_ms / 1000.0,
            counts_per_rev / units,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_at_full_voltage_is_that_of_the_data_sheet() {
        let servo =
            Servo { axis: 1, volts: 10.0, rpm: 3000.0, lines: 2500.0, units_per_rev: None, tau_ms: 15.0 };
        let text = servo.table().expect("numbers above 0");
        let machine = runtime::MachineFile::parse(&text).expect("a machine file");
        let axis = &machine.axes[1];
        // 50 revolutions per second with 10,000 counts each.
        let ku = axis.motor.ku.expect("it is stated");
        assert!((ku * FULL_SCALE - 500_000.0).abs() < 2.0, "{ku}");
        assert_eq!((axis.motor.tau_s, axis.counts_per_unit), (0.015, 1.0));
        let scaled = Servo { units_per_rev: Some(5.0), ..servo };
        let machine = runtime::MachineFile::parse(&scaled.table().expect("numbers")).expect("a machine file");
        assert_eq!(machine.axes[1].counts_per_unit, 2000.0);
        assert!(Servo { rpm: 0.0, ..servo }.table().is_err());
    }
}
