//! Konnect option boards. Source: devices.md section 4.

use kmotiondef::GuestAddr;
use kmotiondef::firmware::Function;
use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::parts::Parts;
use crate::io::konnect::{KonnectBoard, Port, Service};
use crate::out::Message;

/// Addresses on a port.
const ADDRESSES: i32 = 8;

pub(crate) fn init_aux(parts: &mut Parts, _: &mut Caller<'_>) {
    parts.io.konnects.clear();
}

pub(crate) fn add_konnect(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    address: i32,
    outputs: GuestAddr,
    inputs: GuestAddr,
) -> Result<(), TrapKind> {
    add(parts, caller, Function::AddKonnect, Port::Aux1, address, (outputs, inputs))
}

pub(crate) fn add_konnect_aux0(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    address: i32,
    outputs: GuestAddr,
    inputs: GuestAddr,
) -> Result<(), TrapKind> {
    add(parts, caller, Function::AddKonnect_Aux0, Port::Aux0, address, (outputs, inputs))
}

/// Serves a board from now on; addresses of its words that are not mapped are reported as a mistake of the caller, not
/// in a later tick.
fn add(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    function: Function,
    port: Port,
    address: i32,
    (outputs, inputs): (GuestAddr, GuestAddr),
) -> Result<(), TrapKind> {
    caller.memory.load::<i32>(outputs)?;
    caller.memory.load::<i32>(inputs)?;
    if !(0..ADDRESSES).contains(&address) {
        parts.out.diagnose(caller, Message::KonnectAddress { function, address });
    }
    // The address has three lines.
    let board = KonnectBoard { port, address: (address & (ADDRESSES - 1)) as u8 };
    if !parts.io.konnects.is_present(board) {
        parts.out.diagnose(caller, Message::KonnectAbsent { function, address });
    }
    if !parts.io.konnects.add(Service { board, outputs, inputs }) {
        parts.out.console.message("Too many AddKonnects");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::{VIRTUAL_BITS, VIRTUAL_BITS_EX};

    use super::*;
    use crate::testing::TestBench;
    use crate::views::TypedAccess;

    #[test]
    fn inputs_of_each_added_board_read_0() {
        let mut bench = TestBench::new();
        let outputs = VIRTUAL_BITS.address().get();
        bench.call("InitAux", &[]);
        for board in 0..2 {
            let inputs = VIRTUAL_BITS_EX.element(board).address().get();
            bench.call("AddKonnect", &[board as u64, outputs.into(), inputs.into()]);
            bench.memory.set(VIRTUAL_BITS_EX.element(board), -1);
        }
        bench.memory.set(VIRTUAL_BITS, 0x1234);
        bench.run(2);
        assert_eq!(bench.memory.get(VIRTUAL_BITS_EX.element(0)), 0);
        assert_eq!(bench.memory.get(VIRTUAL_BITS_EX.element(1)), 0);
        assert_eq!(bench.memory.get(VIRTUAL_BITS), 0x1234);
    }

    #[test]
    fn a_missing_board_is_reported_and_reads_zero() {
        let mut bench = TestBench::new();
        let word: u64 = VIRTUAL_BITS.address().get().into();
        bench.kernel.parts.io.konnects.set_present(Port::Aux1, 0b01);
        for address in [0, 1] {
            let board = KonnectBoard { port: Port::Aux1, address };
            bench.kernel.parts.io.konnects.drive(board, 5, true);
            let inputs: u64 = VIRTUAL_BITS_EX.element(address.into()).address().get().into();
            bench.call("AddKonnect", &[address.into(), word, inputs]);
        }
        bench.memory.set(VIRTUAL_BITS, 3);
        bench.run(4);
        let inputs = [0, 1].map(|board| bench.memory.get(VIRTUAL_BITS_EX.element(board)));
        let outputs = [0, 1].map(|address| {
            bench.kernel.parts.io.konnects.outputs(KonnectBoard { port: Port::Aux1, address })
        });
        assert_eq!((inputs, outputs), ([32, 0], [3, 0]));
        assert_eq!(bench.kernel.parts.out.take_events().len(), 1);
    }

    #[test]
    fn the_seventeenth_board_is_refused() {
        let mut bench = TestBench::new();
        let word: u64 = VIRTUAL_BITS.address().get().into();
        for board in 0..17 {
            bench.call("AddKonnect_Aux0", &[board, word, word]);
        }
        assert_eq!(bench.printed(), ["Too many AddKonnects"]);
    }
}
