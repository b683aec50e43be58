//! A resistor and a capacitor at outputs: the voltage is exact between edges, and is read by an analog input.
//!
//! `high` alone drives the resistor to the supply and to ground; together with `low`, each output drives only one way,
//! and the capacitor keeps its voltage while neither does. With `konnect` the two are outputs 0 to 15 of that board. An
//! output with a pulse-width signal is followed edge by edge.

use kmotiondef::{Bit, Cycles};

use crate::io::kanalog::COUNTS_PER_VOLT;
use crate::io::konnect::{KonnectBoard, Port};
use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;
use chips::changes::BitChange;
use chips::kanalog::conversion;

/// The location of the outputs.
#[derive(Clone, Copy, Debug)]
enum Driver {
    Bits { high: Bit, low: Option<Bit> },
    Konnect { board: KonnectBoard, high: u32, low: Option<u32> },
}

/// A low pass.
#[derive(Clone, Debug)]
pub(crate) struct Filter {
    driver: Driver,
    adc: usize,
    supply: f64,
    /// Resistance times capacity, in seconds.
    constant: f64,
    is_high: bool,
    is_low: bool,
    /// The capacitor's voltage at an instant.
    voltage: f64,
    at: Cycles,
    shown: i32,
}

impl Filter {
    /// `konnect`, `aux`, `high`, `low`, `adc`, `volts`, `ohms`, `farads`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let address = settings.optional("konnect", "an address from 0 to 7", |text| {
            text.parse().ok().filter(|address| *address < 8)
        })?;
        let port = settings.optional("aux", "0 or 1", |text| match text {
            "0" => Some(Port::Aux0),
            "1" => Some(Port::Aux1),
            _ => None,
        })?;
        let high = settings.bit("high")?;
        let low = settings.optional_bit("low")?;
        let driver = match address {
            None => Driver::Bits { high, low },
            Some(address) => {
                let board = KonnectBoard { port: port.unwrap_or(Port::Aux1), address };
                let low = low.map(|low| u32::from(low.get()));
                Driver::Konnect { board, high: u32::from(high.get()), low }
            }
        };
        Ok(Self {
            driver,
            adc: settings.adc("adc")?,
            supply: settings.number("volts", 10.0)?,
            constant: settings.positive("ohms", 1000.0)? * settings.positive("farads", 1e-6)?,
            is_high: false,
            is_low: false,
            voltage: 0.0,
            at: Cycles::default(),
            shown: conversion(0.0),
        })
    }

    /// Brings the voltage up to an instant.
    fn advance(&mut self, at: Cycles) {
        let seconds = (at - self.at).get() as f64 / Cycles::PER_SECOND.get() as f64;
        self.at = at;
        let target = match (self.is_high, self.is_low) {
            (true, false) => self.supply,
            (false, true) => 0.0,
            (true, true) => self.supply / 2.0,
            (false, false) => return,
        };
        self.voltage = target + (self.voltage - target) * libm::exp(-seconds / self.constant);
    }

    fn set(&mut self, is_high: bool, is_low: bool, at: Cycles) {
        self.advance(at);
        (self.is_high, self.is_low) = (is_high, is_low);
    }
}

impl AttachedDevice for Filter {
    fn edge(&mut self, change: BitChange, _: &mut DeviceContext<'_>) {
        let Driver::Bits { high, low } = self.driver else { return };
        if change.bit == high {
            self.set(change.level, if low.is_some() { self.is_low } else { !change.level }, change.at);
        } else if Some(change.bit) == low {
            self.set(self.is_high, change.level, change.at);
        }
    }

    fn konnect(&mut self, board: KonnectBoard, outputs: u16, at: Cycles) {
        let Driver::Konnect { board: own, high, low } = self.driver else { return };
        if board == own {
            let is_set = |output: u32| u32::from(outputs) >> output & 1 != 0;
            self.set(is_set(high), low.map_or(!is_set(high), is_set), at);
        }
    }

    fn tick(&mut self, now: Cycles, outside: &mut DeviceContext<'_>) {
        self.advance(now);
        self.shown = conversion(self.voltage * COUNTS_PER_VOLT);
        outside.kanalog.drive(self.adc, self.shown);
    }

    fn watches(&self, bit: Bit) -> bool {
        matches!(self.driver, Driver::Bits { high, low } if bit == high || Some(bit) == low)
    }

    fn is_settled(&self) -> bool {
        // Between two conversions it may still move towards the next one.
        !self.is_high && !self.is_low || self.voltage == 0.0 || self.voltage == self.supply
    }
}

#[cfg(test)]
mod tests {
    use crate::io::konnect::{KonnectBoard, Port};
    use crate::world::outside::testing::{Bench, us};

    #[test]
    fn a_bit_charges_and_discharges_the_capacitor() {
        let mut bench = Bench::new("rc high=8 adc=2 volts=5 ohms=1000 farads=1e-6");
        bench.output(8, true, 0);
        // After one time constant: 5 V · (1 − 1/e) = 3.1606 V.
        for (at, expect) in [(1000, 647), (20_000, 1024)] {
            bench.tick(at);
            assert_eq!(bench.adc(2), expect, "{at}");
        }
        bench.output(8, false, 20_000);
        bench.tick(21_000);
        assert_eq!(bench.adc(2), 377);
    }

    #[test]
    fn the_capacitor_keeps_its_charge_when_both_konnect_outputs_are_off() {
        let mut bench = Bench::new("rc konnect=3 aux=0 high=14 low=15 adc=0 volts=10");
        let board = KonnectBoard { port: Port::Aux0, address: 3 };
        bench.device.konnect(board, 1 << 14, us(0));
        bench.device.konnect(board, 0, us(50_000));
        bench.tick(90_000);
        assert_eq!(bench.adc(0), 2047);
        bench.device.konnect(KonnectBoard { port: Port::Aux1, address: 3 }, 1 << 15, us(90_000));
        bench.tick(100_000);
        assert_eq!(bench.adc(0), 2047);
    }
}
